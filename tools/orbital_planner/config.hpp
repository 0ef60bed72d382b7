// config/orbital_planner.yaml, and the shared limits of config/navigation.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "tools/orbital_planner/convert.hpp"
#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

struct ToolConfig {
  PlannerConfig planner;
  PathTerms terms;
};

ToolConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::orbital
