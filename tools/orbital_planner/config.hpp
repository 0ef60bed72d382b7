// Reads config/orbital_planner.yaml.
#pragma once

#include <string>

#include "tools/orbital_planner/convert.hpp"
#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

struct ToolConfig {
  PlannerConfig planner;
  PathTerms terms;
};

ToolConfig load_config(const std::string& config_dir);

}  // namespace rover::orbital
