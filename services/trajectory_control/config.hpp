// Describes and reads config/trajectory_control.yaml; geometry and limits come from config/vehicle.yaml, values that
// other services share from config/navigation.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "trajectory_control/trajectory_controller.hpp"

namespace rover::control {

TrajectoryControlConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::control
