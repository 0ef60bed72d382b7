#include "trajectory_control/convert.hpp"

#include "common/bus/convert.hpp"

namespace rover::control {

PathInput path_from(const path_t& message) {
  PathInput out;
  out.id = message.path_id;
  out.corridor_half_width_m = message.corridor_half_width_m;
  if (message.frame != path_t::ODOM || message.x_m.size() != message.y_m.size()) return out;
  out.points.reserve(message.x_m.size());
  for (size_t i = 0; i < message.x_m.size(); ++i) out.points.emplace_back(message.x_m[i], message.y_m[i]);
  for (const std::int8_t direction : message.direction) out.reverse.push_back(direction == path_t::REVERSE);
  return out;
}

PoseInput pose_from(const pose_t& message, double origin_height_m) {
  PoseInput out;
  out.utime = message.header.utime;
  out.usable = message.status == pose_t::OK || message.status == pose_t::DEGRADED;
  out.odom =
      planar(ground_pose(rover::pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz), origin_height_m));
  out.forward_mps = message.velocity_body_mps[0];
  out.left_mps = message.velocity_body_mps[1];
  return out;
}

void status_to(const ControlOutput& output, control_status_t& message) {
  message.state = static_cast<std::int8_t>(output.state);
  message.path_id = output.path_id;
  message.arc_length_m = output.arc_length_m;
  message.remaining_m = output.remaining_m;
  message.cross_track_m = output.cross_track_m;
  message.heading_error_rad = output.heading_error_rad;
  message.predicted_corridor_error_m = output.predicted_corridor_error_m;
  message.corridor_half_width_m = output.corridor_half_width_m;
}

void command_to(const MotionCommand& command, motion_command_t& message) {
  message.valid_until_utime = command.valid_until;
  message.mode = static_cast<std::int8_t>(command.mode);
  message.speed_mps = command.speed_mps;
  message.curvature_per_m = command.curvature_per_m;
  message.turn_rate_radps = command.turn_rate_radps;
}

}  // namespace rover::control
