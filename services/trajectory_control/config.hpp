// Reads config/trajectory_control.yaml; keys that are absent keep the defaults of the core.
#pragma once

#include <string>

#include "trajectory_control/trajectory_controller.hpp"

namespace rover::control {

TrajectoryControlConfig load_config(const std::string& config_dir);

}  // namespace rover::control
