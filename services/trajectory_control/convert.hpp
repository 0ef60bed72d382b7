// Conversion between LCM messages and the types of the core.
#pragma once

#include <rover/control_status_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>

#include "trajectory_control/trajectory_controller.hpp"

namespace rover::control {

// Returns no points if the message is inconsistent or not in the odom frame.
PathInput path_from(const path_t& message);
PoseInput pose_from(const pose_t& message, double origin_height_m);
void status_to(const ControlOutput& output, control_status_t& message);
void command_to(const MotionCommand& command, motion_command_t& message);

}  // namespace rover::control
