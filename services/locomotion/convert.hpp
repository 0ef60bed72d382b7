// Conversion between LCM messages and the types of the core.
#pragma once

#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "locomotion/locomotion.hpp"

namespace rover::locomotion {

WheelReading reading_from(const wheel_state_t& message);
void setpoints_to(const WheelSetpoints& wheels, wheel_command_t& message);

}  // namespace rover::locomotion
