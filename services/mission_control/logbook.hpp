// The record of a drive: track, events, active path. A checkpoint keeps it over restarts.
#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mission_control/command.hpp"
#include "mission_control/mission_sequence.hpp"

namespace rover::mission {

enum class Tone { kInfo, kGood, kWarn, kBad };

struct Event {
  std::int64_t id = 0;
  double t_s = 0.0;  // message time
  Tone tone = Tone::kInfo;
  std::string kind;  // command, state, level, fault, service, path
  std::string text;
};

// One sample of the trend charts.
struct TrendSample {
  double t_s = 0.0;
  float speed_mps = 0.0F;
  float slip = 0.0F;  // NaN: unknown
  float roll_rad = 0.0F;
  float pitch_rad = 0.0F;
};

class Logbook {
 public:
  void add_event(double t_s, Tone tone, const std::string& kind, const std::string& text);
  // Skips points within 0.1 m of the previous one.
  void add_track_point(double x_m, double y_m);
  // Keeps the last two minutes.
  void sample(const TrendSample& sample);
  void set_path(std::int64_t id, const GlobalPath& path);
  void set_forced(Level level) { forced_ = level; }

  const std::deque<Event>& events() const { return events_; }
  std::int64_t newest_event() const { return events_.empty() ? 0 : events_.back().id; }
  const GlobalPath& path() const { return path_; }
  std::int64_t path_id() const { return path_id_; }
  Level forced() const { return forced_; }
  // Interleaved x, y in map [m].
  const std::vector<float>& track() const { return track_; }

  // Checkpoint bytes. restore() returns false and changes nothing if they are invalid.
  std::vector<std::uint8_t> save() const;
  bool restore(const std::vector<std::uint8_t>& bytes);

  nlohmann::json events_after(std::int64_t id) const;
  nlohmann::json path_json() const;
  nlohmann::json trend_json() const;

 private:
  void decimate_track();

  std::deque<Event> events_;
  std::deque<TrendSample> trend_;
  std::vector<float> track_;
  double spacing_m_ = 0.1;
  GlobalPath path_;
  std::int64_t path_id_ = -1;
  Level forced_ = Level::kAuto;
};

}  // namespace rover::mission
