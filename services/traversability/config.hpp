// Reads config/traversability.yaml and the limits in vehicle.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

struct NodeConfig {
  TraversabilityConfig core;
  Utime latency_us = 100'000;
  double max_map_age_s = 2.0;   // of an elevation map; older ones are rejected
  double max_pose_age_s = 0.5;  // older: difficulty is NaN
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::trav
