#include "tools/report/convert.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/convert.hpp"
#include "common/bus/zone_list.hpp"
#include "common/core/time.hpp"

namespace rover::report {
namespace {

Following following_of(std::int8_t state) {
  switch (state) {
    case control_status_t::FOLLOWING:
    case control_status_t::OUT_OF_CORRIDOR:
      return Following::kFollowing;
    case control_status_t::POINT_TURN:
      return Following::kPointTurn;
    case control_status_t::IDLE:
      return Following::kIdle;
    case control_status_t::PATH_END:
      return Following::kPathEnd;
    default:
      return Following::kOther;
  }
}

std::string response_name(std::int8_t response) {
  static const std::array kNames = {"log", "slow", "stop", "stop_replan", "restart_service", "safe", "stop_backtrack"};
  const auto index = static_cast<size_t>(response);
  return index < kNames.size() ? kNames[index] : "unknown";
}

// Empty if the message contradicts itself.
template <class Message, class StateOf>
std::optional<PassabilityMap> passability_map(const Message& message, StateOf&& state_of) {
  constexpr double kMinCellM = 0.01;
  constexpr double kMaxCellM = 10.0;
  constexpr double kMaxOriginM = 1e6;
  const bool placed = message.cell_m >= kMinCellM && message.cell_m <= kMaxCellM &&
                      std::abs(message.origin_x_m) < kMaxOriginM && std::abs(message.origin_y_m) < kMaxOriginM;
  if (!placed || message.cells_x <= 0 || message.cells_y <= 0 || message.size != message.cells_x * message.cells_y)
    return std::nullopt;
  PassabilityMap map{to_seconds(message.header.utime),
                     message.cell_m,
                     message.origin_x_m,
                     message.origin_y_m,
                     message.cells_x,
                     message.cells_y,
                     {}};
  map.cells.reserve(message.cells.size());
  for (const std::uint8_t cell : message.cells) map.cells.push_back(state_of(cell));
  return map;
}

}  // namespace

TruthSample truth_from(const truth_t& message) {
  TruthSample sample;
  sample.t_s = to_seconds(message.header.utime);
  sample.T_map_body = rover::pose_from(message.position_map_body_m, message.quat_map_body_wxyz);
  sample.speed_mps = std::hypot(message.velocity_map_mps[0], message.velocity_map_mps[1]);
  for (const double slip : message.wheel_slip) sample.wheel_slip += slip / 6.0;
  sample.clearance_m = message.clearance_m;
  sample.collision = message.collision != truth_t::NONE;
  return sample;
}

PoseSample pose_from(const pose_t& message) {
  const Eigen::Array3i planar(0, 1, 5);  // x, y, yaw
  return {to_seconds(message.header.utime), rover::pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz),
          rover::pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz),
          matrix6_from(message.covariance)(planar, planar)};
}

VisualSample visual_from(const vo_motion_t& message) {
  const Eigen::Isometry3d T = rover::pose_from(message.position_m, message.quat_wxyz);
  const bool lost = message.status == vo_motion_t::LOST || !is_finite(T);
  return {to_seconds(message.previous_utime), to_seconds(message.header.utime), lost, T,
          to_seconds(message.keyframe_utime), matrix6_from(message.covariance)};
}

ControlSample control_from(const control_status_t& message) {
  return {to_seconds(message.header.utime), following_of(message.state), message.path_id, message.cross_track_m};
}

WheelSample wheels_from(const wheel_state_t& message) {
  WheelSample sample;
  sample.t_s = to_seconds(message.header.utime);
  std::copy_n(message.drive_current_a, 6, sample.current_a.begin());
  std::copy_n(message.drive_rate_radps, 6, sample.rate_radps.begin());
  std::copy_n(message.steer_angle_rad, 4, sample.steer_rad.begin());
  return sample;
}

SlipSample slip_from(const slip_t& message) {
  return {to_seconds(message.header.utime), message.valid != 0 ? message.slip_ratio : kNaN};
}

StateChange state_from(const supervisor_state_t& message) {
  return {to_seconds(message.header.utime),
          static_cast<State>(message.state),
          message.level == supervisor_state_t::FULL,
          message.cause,
          message.quantity,
          message.value,
          message.threshold};
}

PathRecord path_from(const path_t& message) {
  PathRecord path;
  path.t_s = to_seconds(message.header.release_utime);
  path.id = message.path_id;
  path.in_odom = message.frame == path_t::ODOM;
  path.is_repair = message.kind == path_t::REPAIR;
  path.zones = zones_from(message);
  for (size_t i = 0; i < message.x_m.size(); ++i) path.points.emplace_back(message.x_m[i], message.y_m[i]);
  return path;
}

HazardMap hazards_from(const hazards_t& message) {
  HazardMap map;
  map.t_s = to_seconds(message.header.utime);
  map.released_s = to_seconds(message.header.release_utime);
  map.blind = message.state == hazards_t::BLIND;
  map.coverage = message.coverage;
  map.cell_m = message.cell_m;
  const int columns = message.cells_x;
  for (int i = 0; i < message.size && columns > 0; ++i) {
    const auto cell = static_cast<std::int8_t>(message.cells[static_cast<size_t>(i)]);
    if (cell != hazards_t::OBSTACLE && cell != hazards_t::HOLE && cell != hazards_t::LOW) continue;
    const Eigen::Vector2d p(message.origin_x_m + (i % columns + 0.5) * message.cell_m,
                            message.origin_y_m + (i / columns + 0.5) * message.cell_m);
    map.cells.push_back({p, cell == hazards_t::HOLE});
  }
  return map;
}

std::optional<PassabilityMap> passability_from(const hazards_t& message) {
  return passability_map(message, [](std::uint8_t cell) {
    if (cell == hazards_t::OBSTACLE || cell == hazards_t::HOLE || cell == hazards_t::LOW)
      return PassabilityMap::kImpassable;
    return cell == hazards_t::FREE ? PassabilityMap::kPassable : PassabilityMap::kUnseen;
  });
}

std::optional<PassabilityMap> passability_from(const traversability_t& message) {
  return passability_map(message, [](std::uint8_t cell) {
    if (cell == traversability_t::UNKNOWN) return PassabilityMap::kUnseen;
    return cell >= traversability_t::LOW ? PassabilityMap::kImpassable : PassabilityMap::kPassable;
  });
}

PlannerSample planner_from(const planner_status_t& message) {
  return {to_seconds(message.header.utime), message.state == planner_status_t::NO_PATH,
          message.block_kind == planner_status_t::UNSEEN, message.replans};
}

FaultRecord fault_from(const fault_t& message) {
  return {to_seconds(message.visible_utime), message.id,         message.value, message.limit,
          response_name(message.response),   message.active != 0};
}

CorrectionRecord correction_from(const correction_t& message) {
  const std::string by = message.layer == correction_t::PICTURE ? "by picture" : "by relief";
  return {to_seconds(message.header.utime),
          message.accepted != 0,
          {message.x_m, message.y_m, message.yaw_rad},
          to_seconds(message.header.release_utime),
          message.accepted != 0 ? by : message.reason};
}

SlamSample slam_from(const slam_pose_t& message) {
  return {to_seconds(message.header.utime), {message.drift_x_m, message.drift_y_m, message.drift_yaw_rad}};
}

void add_heartbeat(const heartbeat_t& message, std::map<std::string, ServiceRecord>& services) {
  ServiceRecord& service = services[message.service];
  const std::int64_t boot = message.header.boot_id;
  service.cpu_s_of_boot[boot] = message.cpu_s;
  service.heartbeats.push_back({to_seconds(message.header.utime), boot, message.cpu_s, message.rss_mb});
  service.p50_ms = message.step_p50_ms;
  service.p99_ms = std::max(service.p99_ms, message.step_p99_ms);
  for (const input_health_t& input : message.inputs) service.gaps[{boot, input.channel}] = input.gaps;
}

}  // namespace rover::report
