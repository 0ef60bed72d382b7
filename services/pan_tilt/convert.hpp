// Conversion between messages and core types.
#pragma once

#include <optional>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/ptu_command_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/supervisor_state_t.hpp>

#include "pan_tilt/pan_tilt.hpp"

namespace rover::gaze {

// Empty if the message is invalid.
std::optional<Path> path_from(const path_t& message);
std::optional<RoverPose> pose_from(const pose_t& message);
std::optional<UnitState> unit_from(const ptu_state_t& message);

Task task_of(const supervisor_state_t& state);
ptu_command_t command_of(const Gaze& gaze);

}  // namespace rover::gaze
