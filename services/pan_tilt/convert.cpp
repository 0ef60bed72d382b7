#include "pan_tilt/convert.hpp"

#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::gaze {

std::optional<Path> path_from(const path_t& message) {
  if (message.frame != path_t::ODOM || message.point_count < 2) return std::nullopt;
  Path path;
  for (size_t i = 0; i < message.x_m.size(); ++i) {
    const Eigen::Vector2d point(message.x_m[i], message.y_m[i]);
    if (!point.allFinite()) return std::nullopt;
    // Reverse runs over known ground, and the camera cannot turn that far: it looks to where the rover goes on.
    const bool reverse = message.direction[i] == path_t::REVERSE;
    const bool into_reverse = i > 0 && reverse && message.direction[i - 1] == path_t::FORWARD;
    if (!reverse || into_reverse) path.push_back(point);
  }
  return path;
}

std::optional<RoverPose> pose_from(const pose_t& message) {
  const Eigen::Isometry3d T_odom_body = rover::pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  const bool usable = message.status == pose_t::OK || message.status == pose_t::DEGRADED;
  if (!usable || !is_finite(T_odom_body) || !std::isfinite(message.travelled_m)) return std::nullopt;
  return RoverPose{message.header.utime, planar(T_odom_body), message.travelled_m};
}

std::optional<UnitState> unit_from(const ptu_state_t& message) {
  if (!std::isfinite(message.pan_rad) || !std::isfinite(message.tilt_rad)) return std::nullopt;
  return UnitState{message.header.utime, {message.pan_rad, message.tilt_rad}, message.moving != 0};
}

Task task_of(const supervisor_state_t& state) {
  if (state.level != supervisor_state_t::FULL) return Task::kIdle;
  switch (state.state) {
    case supervisor_state_t::SWEEPING:
      return Task::kSweep;
    case supervisor_state_t::HAZARD_STOP:
    case supervisor_state_t::REPAIRING:
      return Task::kStuck;
    default:
      return Task::kAhead;
  }
}

ptu_command_t command_of(const Gaze& gaze) {
  ptu_command_t command{};
  command.pan_rad = gaze.pan_rad;
  command.tilt_rad = gaze.tilt_rad;
  command.take_image = 1;
  return command;
}

}  // namespace rover::gaze
