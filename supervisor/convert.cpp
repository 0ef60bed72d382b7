#include "supervisor/convert.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/zone_list.hpp"

namespace rover::supervisor {
namespace {

// LCM has no optional values: a missing number is sent as 0 with an empty quantity name.
double number_or_zero(double value) {
  return std::isnan(value) ? 0.0 : value;
}

}  // namespace

PoseReport report_from(const pose_t& message, double origin_height_m) {
  PoseReport out;
  out.utime = message.header.utime;
  out.speed_mps = Eigen::Vector3d(message.velocity_body_mps).norm();
  out.forward_mps = message.velocity_body_mps[0];
  out.turn_rate_radps = message.rate_body_radps[2];
  const Eigen::Isometry3d T_odom_body = pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  out.odom = planar(ground_pose(T_odom_body, origin_height_m));
  const Eigen::Vector3d attitude = rpy_of(T_odom_body.linear());
  out.roll_rad = attitude.x();
  out.pitch_rad = attitude.y();
  out.tilt_rate_radps = std::hypot(message.rate_body_radps[0], message.rate_body_radps[1]);
  const double variance_x = message.covariance[0], variance_y = message.covariance[7];
  const bool known_sigma = std::isfinite(variance_x) && std::isfinite(variance_y);
  out.sigma_m = known_sigma ? std::sqrt(std::max(variance_x, variance_y)) : kNaN;
  out.travelled_m = message.travelled_m;
  out.vo_utime = message.last_vo_utime;
  const bool known = message.status == pose_t::OK || message.status == pose_t::DEGRADED;
  const auto finite = [](const Eigen::Isometry3d& T) { return is_finite(T); };
  out.usable = known && finite(T_odom_body) &&
               finite(pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz)) &&
               std::isfinite(out.speed_mps) && std::isfinite(out.turn_rate_radps);
  return out;
}

HazardsReport report_from(const hazards_t& message) {
  const bool known = message.state == hazards_t::CLEAR || message.state == hazards_t::HAZARD;
  return {message.header.utime, !known || !std::isfinite(message.coverage), message.coverage};
}

PlannerReport report_from(const planner_status_t& message) {
  PlannerReport out;
  out.utime = message.header.utime;
  out.state = static_cast<PlannerState>(message.state);
  out.path_id = message.path_id;
  out.global_path_id = message.global_path_id;
  out.blocked_in_m = message.blocked_in_m;
  out.goal_distance_m = message.goal_distance_m;
  out.replans = message.replans;
  return out;
}

ControlReport report_from(const control_status_t& message) {
  ControlReport out;
  out.utime = message.header.utime;
  out.path_end = message.state == control_status_t::PATH_END;
  out.stale_pose = message.state == control_status_t::STALE_POSE;
  out.out_of_corridor = message.state == control_status_t::OUT_OF_CORRIDOR;
  out.path_id = message.path_id;
  out.cross_track_m = message.cross_track_m;
  out.corridor_half_width_m = message.corridor_half_width_m;
  out.predicted_error_m = message.predicted_corridor_error_m;
  out.arc_length_m = message.arc_length_m;
  return out;
}

SlipReport report_from(const slip_t& message) {
  return {message.header.utime, message.valid == 1, message.slip_ratio};
}

// A non-finite current or rate is a sensor fault.
WheelReport report_from(const wheel_state_t& message) {
  const auto finite = [](const auto& values) {
    return std::all_of(std::begin(values), std::end(values), [](double v) { return std::isfinite(v); });
  };
  WheelReport out;
  out.utime = message.header.utime;
  out.fault = message.status == wheel_state_t::FAULT || !finite(message.drive_current_a) ||
              !finite(message.steer_current_a) || !finite(message.drive_rate_radps);
  std::copy_n(message.drive_current_a, 6, out.drive_current_a.begin());
  std::copy_n(message.steer_current_a, 4, out.steer_current_a.begin());
  std::copy_n(message.drive_rate_radps, 6, out.drive_rate_radps.begin());
  return out;
}

// A non-finite increment is a sensor fault.
ImuReport report_from(const imu_t& message) {
  bool finite = std::isfinite(message.fog_delta_yaw_rad);
  for (int i = 0; i < 3; ++i)
    finite = finite && std::isfinite(message.delta_angle_rad[i]) && std::isfinite(message.delta_velocity_mps[i]);
  return {message.header.utime, message.status != imu_t::OK || !finite};
}

TerrainReport report_from(const traversability_t& message, const Pose2& body_odom) {
  TerrainReport out;
  out.utime = message.header.utime;
  out.difficulty = message.difficulty;
  const CostmapView map{message.cell_m,  message.origin_x_m, message.origin_y_m,       message.cells_x,
                        message.cells_y, message.cells,      traversability_t::UNKNOWN};
  out.known = known_fractions(map, body_odom);
  return out;
}

VisualReport report_from(const vo_motion_t& message) {
  return {message.header.utime, message.status == vo_motion_t::DISPLACED};
}

SlamReport report_from(const slam_pose_t& message) {
  return {message.header.utime, message.status == slam_pose_t::LOST};
}

ServiceReport report_from(const heartbeat_t& message) {
  ServiceReport out;
  out.utime = message.header.utime;
  out.boot_id = message.header.boot_id;
  out.pid = message.pid;
  const bool known = message.status >= heartbeat_t::OK && message.status <= heartbeat_t::FAULT;
  out.status = known ? static_cast<ServiceStatus>(message.status) : ServiceStatus::kFault;
  for (const input_health_t& input : message.inputs) {
    // Ticks have no detectable gaps (clock_step covers them); counting them would dilute the loss ratio.
    if (input.channel != channel::kTick) out.received += input.received;
    out.lost += input.gaps + input.malformed;  // late messages already counted as gaps; duplicates are not losses
  }
  return out;
}

PathLevels levels_from(const path_t& message) {
  PathLevels out;
  const size_t count = std::min({message.x_m.size(), message.y_m.size(), message.level.size()});
  out.path_id = message.path_id;
  out.backtrack = message.kind == path_t::BACKTRACK;
  out.zones = zones_from(message);
  double s_m = 0.0;
  for (size_t i = 0; i < count; ++i) {
    if (i > 0) s_m += std::hypot(message.x_m[i] - message.x_m[i - 1], message.y_m[i] - message.y_m[i - 1]);
    out.s_m.push_back(s_m);
    out.level.push_back(message.level[i] == path_t::FULL ? Level::kFull : Level::kEfficient);
  }
  return out;
}

GroundCommand command_from(const ground_command_t& message) {
  GroundCommand out;
  out.id = message.command_id;
  out.kind = static_cast<CommandKind>(message.kind);
  out.target = message.target;
  out.level = static_cast<ForcedLevel>(message.level);
  return out;
}

drive_permit_t message_of(const Permit& permit) {
  drive_permit_t out{};
  out.granted = permit.granted ? 1 : 0;
  out.valid_until_utime = permit.valid_until;
  out.max_speed_mps = permit.max_speed_mps;
  out.reason = permit.reason;
  return out;
}

fault_t message_of(const FaultChange& change) {
  fault_t out{};
  out.id = change.id;
  out.condition = static_cast<std::int8_t>(change.condition);
  out.response = static_cast<std::int8_t>(change.response);
  out.value = change.value;
  out.limit = change.limit;
  out.visible_utime = change.visible_utime;
  out.active = change.active ? 1 : 0;
  out.first = change.first ? 1 : 0;
  return out;
}

supervisor_state_t state_message(const StateChange& change, Utime since, int hazard_stops,
                                 const std::vector<std::string>& faults) {
  supervisor_state_t out{};
  out.state = static_cast<std::int8_t>(change.to);
  out.level = static_cast<std::int8_t>(change.level_to);
  out.since_utime = since;
  out.cause = change.cause;
  out.quantity = change.evidence.quantity;
  out.value = number_or_zero(change.evidence.value);
  out.threshold = number_or_zero(change.evidence.threshold);
  out.persistence_s = change.evidence.persistence_s;
  out.data_age_s = change.evidence.data_age_s;
  out.hazard_stops = hazard_stops;
  out.fault_count = static_cast<std::int32_t>(faults.size());
  out.faults = faults;
  return out;
}

}  // namespace rover::supervisor
