// config/path_planner.yaml, with geometry and limits from config/vehicle.yaml.
#pragma once

#include <string>

#include "path_planner/path_planner.hpp"

namespace rover::planning {

PathPlannerConfig load_config(const std::string& config_dir);

}  // namespace rover::planning
