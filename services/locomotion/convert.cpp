#include "locomotion/convert.hpp"

#include <algorithm>

namespace rover::locomotion {

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
