#include "mission_control/logbook.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "mission_control/zones_json.hpp"

namespace rover::mission {
namespace {

using nlohmann::json;

constexpr double kTrendWindowS = 120.0;
constexpr size_t kMaxEvents = 400;
constexpr size_t kMaxPoints = 20'000;
constexpr std::array kTones = {"info", "good", "warn", "bad"};

json to_json(const Event& event) {
  return {{"id", event.id},
          {"t_s", event.t_s},
          {"tone", kTones[static_cast<size_t>(event.tone)]},
          {"kind", event.kind},
          {"text", event.text}};
}

Event event_from(const json& value) {
  Event event;
  event.id = value.at("id");
  event.t_s = value.at("t_s");
  event.kind = value.at("kind");
  event.text = value.at("text");
  for (size_t i = 0; i < kTones.size(); ++i)
    if (value.at("tone") == kTones[i]) event.tone = static_cast<Tone>(i);
  return event;
}

std::vector<std::uint8_t> bytes_of(const std::vector<float>& numbers) {
  std::vector<std::uint8_t> bytes(numbers.size() * sizeof(float));
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::vector<float> floats_from(const std::vector<std::uint8_t>& bytes) {
  std::vector<float> numbers(bytes.size() / (2 * sizeof(float)) * 2);
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

}  // namespace

void Logbook::add_event(double t_s, Tone tone, const std::string& kind, const std::string& text) {
  events_.push_back({newest_event() + 1, t_s, tone, kind, text});
  if (events_.size() > kMaxEvents) events_.pop_front();
}

void Logbook::add_track_point(double x_m, double y_m) {
  if (!std::isfinite(x_m) || !std::isfinite(y_m)) return;
  if (!track_.empty()) {
    const double dx = x_m - track_[track_.size() - 2];
    const double dy = y_m - track_.back();
    if (dx * dx + dy * dy < spacing_m_ * spacing_m_) return;
  }
  track_.push_back(static_cast<float>(x_m));
  track_.push_back(static_cast<float>(y_m));
  if (track_.size() > 2 * kMaxPoints) decimate_track();
}

// Drops every second point and doubles the spacing of later points.
void Logbook::decimate_track() {
  std::vector<float> kept;
  for (size_t i = 0; i + 1 < track_.size(); i += 4) kept.insert(kept.end(), {track_[i], track_[i + 1]});
  track_ = std::move(kept);
  spacing_m_ *= 2.0;
}

void Logbook::sample(const TrendSample& sample) {
  trend_.push_back(sample);
  while (trend_.front().t_s < sample.t_s - kTrendWindowS) trend_.pop_front();
}

void Logbook::set_path(std::int64_t id, const GlobalPath& path) {
  path_id_ = id;
  path_ = path;
}

json Logbook::events_after(std::int64_t id) const {
  json out = json::array();
  for (const Event& event : events_)
    if (event.id > id) out.push_back(to_json(event));
  return out;
}

json Logbook::path_json() const {
  return {{"id", path_id_},
          {"x_m", path_.x_m},
          {"y_m", path_.y_m},
          {"level", path_.level},
          {"corridor_half_width_m", path_.corridor_half_width_m},
          {"goal_tolerance_m", path_.goal_tolerance_m},
          {"zones", zones_json(path_.zones)}};
}

json Logbook::trend_json() const {
  json out = json::array();
  for (const TrendSample& s : trend_) out.push_back({s.t_s, s.speed_mps, s.slip, s.roll_rad, s.pitch_rad});
  return out;
}

std::vector<std::uint8_t> Logbook::save() const {
  json out = {{"events", events_after(0)}, {"path", path_json()}, {"forced", static_cast<int>(forced_)}};
  out["spacing_m"] = spacing_m_;
  out["track"] = json::binary(bytes_of(track_));
  return json::to_cbor(out);
}

bool Logbook::restore(const std::vector<std::uint8_t>& bytes) {
  try {
    const json in = json::from_cbor(bytes);
    Logbook restored;
    for (const json& event : in.at("events")) restored.events_.push_back(event_from(event));
    const json& path = in.at("path");
    restored.path_id_ = path.at("id");
    restored.path_.x_m = path.at("x_m").get<std::vector<double>>();
    restored.path_.y_m = path.at("y_m").get<std::vector<double>>();
    restored.path_.level = path.at("level").get<std::vector<std::int8_t>>();
    restored.path_.corridor_half_width_m = path.at("corridor_half_width_m");
    restored.path_.goal_tolerance_m = path.at("goal_tolerance_m");
    restored.path_.zones = zones_from(path.at("zones"));
    const int forced = in.at("forced");
    if (forced < 0 || forced > static_cast<int>(Level::kAuto)) return false;
    restored.forced_ = static_cast<Level>(forced);
    restored.spacing_m_ = in.at("spacing_m");
    restored.track_ = floats_from(in.at("track").get_binary());
    *this = std::move(restored);
    return true;
  } catch (const json::exception&) {
    return false;
  }
}

}  // namespace rover::mission
