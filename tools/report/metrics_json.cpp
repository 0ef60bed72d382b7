#include "tools/report/metrics_json.hpp"

#include <cmath>

#include "tools/report/fidelity_json.hpp"
#include "tools/report/no_truth.hpp"

namespace rover::report {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN or infinity: null means not applicable or unknown.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class T>
Json optional(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json text(const std::string& value) {
  return value.empty() ? Json(nullptr) : Json(value);
}

// Enough digits to restore the same double.
Json pose_json(const std::optional<Eigen::Isometry3d>& T) {
  if (!T) return nullptr;
  const Eigen::Quaterniond q(T->linear());
  return {{"x_m", T->translation().x()},
          {"y_m", T->translation().y()},
          {"z_m", T->translation().z()},
          {"qw", q.w()},
          {"qx", q.x()},
          {"qy", q.y()},
          {"qz", q.z()}};
}

Json switches_json(const Metrics& m) {
  Json list = Json::array();
  for (const LevelSwitch& change : m.level_switches)
    list.push_back({{"t_s", change.t_s},
                    {"from", change.to_full ? "EFFICIENT" : "FULL"},
                    {"to", change.to_full ? "FULL" : "EFFICIENT"},
                    {"reason", change.reason},
                    {"at_m", number(change.at_m)},
                    {"quantity", text(change.quantity)},
                    {"value", number(change.value)},
                    {"threshold", number(change.threshold)}});
  return list;
}

Json level_json(const LevelFigures& level) {
  return {{"travelled_m", level.travelled_m}, {"time_s", level.time_s}, {"hazard_stops", level.hazard_stops}};
}

Json corrections_json(const Metrics& m) {
  Json list = Json::array();
  for (const CorrectionFigure& correction : m.global_corrections)
    list.push_back({{"t_s", correction.t_s},
                    {"before_m", number(correction.before_m)},
                    {"after_m", number(correction.after_m)},
                    {"correction_error_m", number(correction.correction_error_m)},
                    {"accepted", correction.accepted},
                    {"reason", text(correction.reason)}});
  return list;
}

Json fdir_json(const Metrics& m) {
  Json list = Json::array();
  for (const FaultRecord& fault : m.fdir)
    list.push_back({{"t_s", fault.t_s},
                    {"id", fault.id},
                    {"value", number(fault.value)},
                    {"limit", number(fault.limit)},
                    {"response", fault.response}});
  return list;
}

Json services_json(const Metrics& m) {
  Json services = Json::object();
  for (const auto& [name, s] : m.services)
    services[name] = {{"cpu_s", s.cpu_s},
                      {"cpu_s_per_m", number(s.cpu_s_per_m)},
                      {"cpu_s_per_m_efficient", number(s.cpu_s_per_m_efficient)},
                      {"cpu_s_per_m_full", number(s.cpu_s_per_m_full)},
                      {"rss_mb", s.rss_mb},
                      {"rss_first_half_mb", s.rss_first_half_mb},
                      {"restarts", s.restarts},
                      {"p50_ms", s.p50_ms},
                      {"p99_ms", s.p99_ms}};
  return services;
}

Json seconds_json(const TimeAccount& time) {
  Json seconds;
  for (int i = 0; i < kTimeCauses; ++i) {
    const auto cause = static_cast<TimeCause>(i);
    seconds[key_of(cause)] = time.of(cause);
  }
  return seconds;
}

void add_run(const Metrics& m, Json& json) {
  json["scenario"] = text(m.info.scenario);
  json["seed"] = optional(m.info.seed);
  json["commit"] = text(m.info.commit);
  json["level"] = text(m.info.level);
  json["perception"] = text(m.info.perception);
  json["deterministic"] = optional(m.info.deterministic);
  json["truth"] = has_truth(m);
  json["outcome"] = m.outcome;
}

void add_drive(const Metrics& m, Json& json) {
  json["planned_length_m"] = number(m.planned_length_m);
  json["driven_length_m"] = number(m.driven_length_m);
  json["path_ratio"] = number(m.path_ratio);
  json["oracle_m"] = number(m.oracle_m);
  json["oracle_feasible"] = optional(m.oracle_feasible);
  json["regret"] = number(m.regret);
  json["duration_s"] = number(m.duration_s);
  json["progress"] = number(m.progress);
  json["duty"] = number(m.duty);
  json["seconds"] = seconds_json(m.time);
  json["reverse_m"] = number(m.reverse_m);
  json["mean_speed_m_per_h"] = number(m.mean_speed_m_per_h);
  json["hazard_stops"] = m.hazard_stops;
  json["replans"] = m.replans;
  json["replans_per_m"] = number(m.replans_per_m);
  json["level_switches"] = switches_json(m);
  json["levels"] = {{"EFFICIENT", level_json(m.efficient)}, {"FULL", level_json(m.full)}};
  json["collisions"] = has_truth(m) ? Json(m.collisions) : Json(nullptr);
  json["min_clearance_m"] = number(m.min_clearance_m);
  json["hazard_clearance_m"] = number(m.hazard_clearance_m);
  json["max_roll_deg"] = number(m.max_roll_deg);
  json["max_pitch_deg"] = number(m.max_pitch_deg);
  json["rms_roll_deg"] = number(m.rms_roll_deg);
  json["rms_pitch_deg"] = number(m.rms_pitch_deg);
  json["mean_slip"] = number(m.mean_slip);
  json["mean_abs_current_a"] = number(m.mean_abs_current_a);
  json["max_current_a"] = number(m.max_current_a);
  json["time_in_state_s"] = m.time_in_state_s;
  json["point_turn_s"] = m.point_turn_s;
}

Json trajectory_json(const TrajectoryError& error) {
  const auto segment = [](const SegmentError& s) {
    return Json{{"length_m", number(s.length_m)},
                {"count", s.count},
                {"translation_percent", number(s.translation_percent)},
                {"rotation_deg_per_m", number(s.rotation_deg_per_m)}};
  };
  Json segments = Json::array();
  for (const SegmentError& s : error.segments) segments.push_back(segment(s));
  return {{"poses", error.poses},
          {"length_m", number(error.length_m)},
          {"end_error_m", number(error.end_error_m)},
          {"end_error_percent", number(error.end_error_percent)},
          {"ate_rmse_m", number(error.ate_rmse_m)},
          {"ate_max_m", number(error.ate_max_m)},
          {"rpe_rmse_m", number(error.rpe_rmse_m)},
          {"rpe_rmse_deg", number(error.rpe_rmse_deg)},
          {"segments", segments},
          {"all_segments", segment(error.all_segments)}};
}

void add_accuracy(const Metrics& m, Json& json) {
  json["cross_track_rms_m"] = number(m.cross_track_rms_m);
  json["cross_track_max_m"] = number(m.cross_track_max_m);
  json["truth_deviation_max_m"] = number(m.truth_deviation_max_m);
  json["odometry_drift_percent"] = number(m.odometry_drift_percent);
  json["odometry_drift_max_m"] = number(m.odometry_drift_max_m);
  json["slam_drift_percent"] = number(m.slam_drift_percent);
  json["slam_odometry_ratio"] = number(m.slam_odometry_ratio);
  json["estimate_error_max_m"] = number(m.estimate_error_max_m);
  json["corrected_error_max_m"] = number(m.corrected_error_max_m);
  json["final_error_m"] = number(m.final_error_m);
  json["final_estimate_error_m"] = number(m.final_estimate_error_m);
  json["anees"] = anees_json(m.anees);
  json["anees_after_fix"] = anees_json(m.anees_after_fix);
  json["vo_nees"] = vo_nees_json(m.visual_consistency);
  json["global_corrections"] = corrections_json(m);
  json["trajectory"] = {{"data_set_pairs", optional(m.info.data_set_pairs)},
                        {"visual_odometry", trajectory_json(m.visual_odometry)},
                        {"published_pose", trajectory_json(m.published_pose)}};
}

void add_hazards(const Metrics& m, Json& json) {
  json["rocks_encountered"] = optional(m.rocks_encountered);
  json["rocks_detected"] = optional(m.rocks_detected);
  json["rocks_missed"] = optional(m.rocks_missed);
  json["false_stops"] = optional(m.false_stops);
  json["unobserved_stops"] = m.unobserved_stops;
  json["hazard_frames"] = m.hazard_frames;
  json["hazard_frames_without_coverage"] = m.hazard_frames_without_coverage;
  json["hazard_coverage_mean"] = number(m.hazard_coverage_mean);
  json["map"] = map_json(m.map);
  json["vo_frames"] = m.vo_frames;
  json["vo_lost"] = m.vo_lost;
}

}  // namespace

Json metrics_json(const Metrics& m) {
  Json json;
  add_run(m, json);
  add_drive(m, json);
  add_accuracy(m, json);
  add_hazards(m, json);
  json["motion_without_lease_s"] = number(m.motion_without_lease_s);
  json["fdir"] = fdir_json(m);
  json["services"] = services_json(m);
  json["bus"] = {{"messages", m.bus.messages},
                 {"lost", m.bus_lost},
                 {"bytes", m.bus.bytes},
                 {"damaged_log_records", m.bus.damaged_events},
                 {"missing_s", m.bus.missing_s}};
  json["realtime_factor"] = number(m.realtime_factor);
  json["sim_s"] = optional(m.info.sim_s);
  json["wall_s"] = optional(m.info.wall_s);
  json["final_truth_pose"] = pose_json(m.final_truth_pose);
  return json;
}

}  // namespace rover::report
