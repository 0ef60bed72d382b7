// config/path_planner.yaml, with geometry and limits from config/vehicle.yaml and navigation.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "path_planner/path_planner.hpp"

namespace rover::planning {

PathPlannerConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::planning
