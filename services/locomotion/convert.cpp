#include "locomotion/convert.hpp"

#include <algorithm>

namespace rover::locomotion {

MotionCommand command_from(const motion_command_t& message) {
  MotionCommand out;
  out.utime = message.header.utime;
  out.valid_until = message.valid_until_utime;
  if (message.mode == motion_command_t::ARC) out.mode = MotionMode::kArc;
  if (message.mode == motion_command_t::POINT_TURN) out.mode = MotionMode::kPointTurn;
  out.speed_mps = message.speed_mps;
  out.curvature_per_m = message.curvature_per_m;
  out.turn_rate_radps = message.turn_rate_radps;
  return out;
}

DrivePermit permit_from(const drive_permit_t& message) {
  return {message.header.utime, message.valid_until_utime, message.granted == 1, message.max_speed_mps};
}

WheelReading reading_from(const wheel_state_t& message) {
  WheelReading out;
  out.utime = message.header.utime;
  std::copy(std::begin(message.steer_angle_rad), std::end(message.steer_angle_rad), out.steer_angle_rad.begin());
  out.command_expired = message.status == wheel_state_t::COMMAND_EXPIRED;
  out.fault = message.status != wheel_state_t::OK && !out.command_expired;
  return out;
}

void setpoints_to(const WheelSetpoints& wheels, wheel_command_t& message) {
  std::copy(wheels.drive_rate_radps.begin(), wheels.drive_rate_radps.end(), message.drive_rate_radps);
  std::copy(wheels.steer_angle_rad.begin(), wheels.steer_angle_rad.end(), message.steer_angle_rad);
}

}  // namespace rover::locomotion
