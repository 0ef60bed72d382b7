// Conversion between LCM messages and the types of the core.
#pragma once

#include <rover/drive_permit_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "locomotion/locomotion.hpp"

namespace rover::locomotion {

MotionCommand command_from(const motion_command_t& message);
DrivePermit permit_from(const drive_permit_t& message);
WheelReading reading_from(const wheel_state_t& message);
void setpoints_to(const WheelSetpoints& wheels, wheel_command_t& message);

}  // namespace rover::locomotion
