#include "supervisor/convert.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::supervisor {
namespace {

// LCM has no value for "none": a quantity without a number goes out as zero, its name is then empty.
double number_or_zero(double value) {
  return std::isnan(value) ? 0.0 : value;
}

}  // namespace

PoseReport report_from(const pose_t& message) {
  PoseReport out;
  out.utime = message.header.utime;
  out.speed_mps = Eigen::Vector3d(message.velocity_body_mps).norm();
  out.turn_rate_radps = message.rate_body_radps[2];
  const bool known = message.status == pose_t::OK || message.status == pose_t::DEGRADED;
  const auto finite = [](const Eigen::Isometry3d& T) { return is_finite(T); };
  out.usable = known && finite(pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz)) &&
               finite(pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz)) &&
               std::isfinite(out.speed_mps) && std::isfinite(out.turn_rate_radps);
  return out;
}

HazardsReport report_from(const hazards_t& message) {
  const bool known = message.state == hazards_t::CLEAR || message.state == hazards_t::HAZARD;
  return {message.header.utime, !known || !std::isfinite(message.coverage)};
}

PlannerReport report_from(const planner_status_t& message) {
  PlannerReport out;
  out.utime = message.header.utime;
  out.state = static_cast<PlannerState>(message.state);
  out.path_id = message.path_id;
  out.blocked_in_m = message.blocked_in_m;
  // What is not known as unseen ground counts as a hazard, with the longer stopping distance.
  out.block_kind = message.block_kind == planner_status_t::UNSEEN ? BlockKind::kUnseen : BlockKind::kHazard;
  out.goal_distance_m = message.goal_distance_m;
  return out;
}

ControlReport report_from(const control_status_t& message) {
  ControlReport out;
  out.utime = message.header.utime;
  out.path_end = message.state == control_status_t::PATH_END;
  out.out_of_corridor = message.state == control_status_t::OUT_OF_CORRIDOR;
  out.path_id = message.path_id;
  out.cross_track_m = message.cross_track_m;
  out.corridor_half_width_m = message.corridor_half_width_m;
  return out;
}

SlipReport report_from(const slip_t& message) {
  return {message.header.utime, message.valid == 1, message.slip_ratio};
}

GroundCommand command_from(const ground_command_t& message) {
  GroundCommand out;
  out.id = message.command_id;
  out.kind = static_cast<CommandKind>(message.kind);
  out.target = message.target;
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
  out.standing = change.standing ? 1 : 0;
  out.first = change.first ? 1 : 0;
  return out;
}

supervisor_state_t state_message(const StateChange& change, Utime since, int hazard_stops,
                                 const std::vector<std::string>& faults) {
  supervisor_state_t out{};
  out.state = static_cast<std::int8_t>(change.to);
  out.level = supervisor_state_t::EFFICIENT;
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
