#include <cmath>
#include <nlohmann/json.hpp>

#include "mission_control/view.hpp"

namespace rover::mission {
namespace {

using nlohmann::json;

constexpr std::array kHealth = {"ok", "degraded", "fault", "lost", "waiting", "stopped"};

// Rounds to the displayed digits to save bandwidth.
json rounded(double value, double step) {
  if (!std::isfinite(value)) return nullptr;
  const double n = std::round(value / step);
  return step < 1.0 ? json(n / std::round(1.0 / step)) : json(n * step);
}

json metres(double value) {
  return rounded(value, 0.001);
}
json angle(double value) {
  return rounded(value, 0.0001);
}

json since(Utime utime, Utime now) {
  if (utime == kNever || now == kNever) return nullptr;
  return rounded(to_seconds(now - utime), 0.01);
}

json pose2(const Pose2& p) {
  return {metres(p.x_m), metres(p.y_m), rounded(p.yaw_rad, 1e-5)};
}

json of(const StateView& s, const std::map<std::string, FaultView>& known, Utime now) {
  json faults = json::array();
  for (const std::string& id : s.faults) {
    const auto it = known.find(id);
    const FaultView fault = it == known.end() ? FaultView{} : it->second;
    faults.push_back({{"id", id},
                      {"value", rounded(fault.value, 0.001)},
                      {"limit", rounded(fault.limit, 0.001)},
                      {"response", fault.response}});
  }
  return {{"name", s.state},
          {"level", s.level},
          {"since_s", since(s.since, now)},
          {"age_s", since(s.utime, now)},
          {"cause", s.cause},
          {"quantity", s.quantity},
          {"value", rounded(s.value, 0.001)},
          {"threshold", rounded(s.threshold, 0.001)},
          {"hazard_stops", s.hazard_stops},
          {"faults", faults}};
}

json of(const PermitView& p, Utime now) {
  return {
      {"granted", p.granted && now <= p.valid_until}, {"max_speed_mps", metres(p.max_speed_mps)}, {"reason", p.reason}};
}

json of(const PoseView& p, Utime now) {
  return {{"status", p.status},
          {"x_m", metres(p.position_map_m.x())},
          {"y_m", metres(p.position_map_m.y())},
          {"z_m", metres(p.position_map_m.z())},
          {"roll", angle(p.roll_rad)},
          {"pitch", angle(p.pitch_rad)},
          {"yaw", angle(p.yaw_rad)},
          {"speed_mps", metres(p.speed_mps)},
          {"sigma_m", metres(p.sigma_m)},
          {"travelled_m", metres(p.travelled_m)},
          {"odom", pose2(p.map_odom)},
          {"age_s", since(p.utime, now)}};
}

json of(const PlannerView& p) {
  return {{"state", p.state},
          {"blocked_in_m", metres(p.blocked_in_m)},
          {"goal_distance_m", metres(p.goal_distance_m)},
          {"corridor_offset_m", metres(p.corridor_offset_m)},
          {"replans", p.replans},
          {"text", p.text}};
}

json of(const MotionView& m) {
  json currents = json::array();
  json steering = json::array();
  for (const double value : m.drive_current_a) currents.push_back(rounded(value, 0.01));
  for (const double value : m.steer_rad) steering.push_back(angle(value));
  return {{"slip", metres(m.slip_ratio)},
          {"cross_track_m", metres(m.cross_track_m)},
          {"corridor_m", metres(m.corridor_half_width_m)},
          {"currents_a", currents},
          {"steer", steering}};
}

// Null: nothing received.
json of(const PanTiltView& p) {
  if (p.utime == kNever) return nullptr;
  return {{"pan", angle(p.pan_rad)}, {"tilt", angle(p.tilt_rad)}, {"moving", p.moving}};
}

json of(const TerrainView& t, Utime now) {
  if (t.utime == kNever) return nullptr;
  return {{"age_s", since(t.utime, now)},
          {"difficulty", rounded(t.difficulty, 0.01)},
          {"known", rounded(t.known_fraction, 0.01)}};
}

json of(const SlamView& s, Utime now) {
  if (s.utime == kNever) return nullptr;
  return {{"age_s", since(s.utime, now)},
          {"status", s.status},
          {"information", rounded(s.information, 0.01)},
          {"particles", s.particles}};
}

json of(const CorrectionView& c, Utime now) {
  if (c.utime == kNever) return nullptr;
  return {{"age_s", since(c.utime, now)},
          {"accepted", c.accepted},
          {"moved_m", rounded(c.moved_m, 0.01)},
          {"score", rounded(c.score, 0.01)},
          {"reason", c.reason}};
}

json of(const std::map<std::string, ServiceView>& services) {
  json out = json::array();
  for (const auto& [name, s] : services)
    out.push_back({{"name", name},
                   {"health", kHealth[static_cast<size_t>(s.health)]},
                   {"age_s", rounded(s.age_s, 0.01)},
                   {"cpu", rounded(s.cpu_percent, 0.1)},
                   {"rss_mb", rounded(s.rss_mb, 1.0)},
                   {"restarts", s.restarts < 0 ? json() : json(s.restarts)},
                   {"text", s.text}});
  return out;
}

json of(const std::map<std::string, GridView>& grids, Utime now) {
  json out = json::object();
  for (const auto& [name, g] : grids)
    out[name] = {{"seq", g.seq},
                 {"age_s", since(g.utime, now)},
                 {"odom", pose2(g.odom)},
                 {"cell_m", g.cell_m},
                 {"x_m", metres(g.origin_x_m)},
                 {"y_m", metres(g.origin_y_m)},
                 {"nx", g.cells_x},
                 {"ny", g.cells_y},
                 {"note", g.note},
                 {"plane", {angle(g.plane_pitch_rad), angle(g.plane_roll_rad)}}};
  return out;
}

json of(const std::map<std::string, ImageView>& images, Utime now) {
  json out = json::object();
  for (const auto& [name, i] : images)
    out[name] = {{"seq", i.seq}, {"age_s", since(i.utime, now)}, {"width", i.width}, {"height", i.height}};
  return out;
}

json of(const BookView& b) {
  return {{"event", b.newest_event},
          {"path", b.path_id},
          {"path_length_m", metres(b.path_length_m)},
          {"forced", b.forced_level},
          {"pages", b.pages}};
}

// Bus texts may contain invalid UTF-8.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string to_json(const View& v, const BookView& book) {
  const json out = {{"t_s", v.now == kNever ? json() : json(rounded(to_seconds(v.now), 0.01))},
                    {"rate", rounded(v.realtime_factor, 0.01)},
                    {"tick_age_s", rounded(v.tick_age_s, 0.1)},
                    {"state", of(v.state, v.faults, v.now)},
                    {"permit", of(v.permit, v.now)},
                    {"pose", of(v.pose, v.now)},
                    {"planner", of(v.planner)},
                    {"motion", of(v.motion)},
                    {"pan_tilt", of(v.pan_tilt)},
                    {"terrain", of(v.terrain, v.now)},
                    {"slam", of(v.slam, v.now)},
                    {"correction", of(v.correction, v.now)},
                    {"services", of(v.services)},
                    {"path", v.path.id},
                    {"grids", of(v.grids, v.now)},
                    {"images", of(v.images, v.now)},
                    {"book", of(book)}};
  return text_of(out);
}

std::string to_json(const TruthView& t) {
  return text_of({{"x_m", metres(t.position_map_m.x())},
                  {"y_m", metres(t.position_map_m.y())},
                  {"yaw", angle(t.yaw_rad)},
                  {"t_s", rounded(to_seconds(t.utime), 0.01)}});
}

}  // namespace rover::mission
