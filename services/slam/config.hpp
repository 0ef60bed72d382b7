// config/slam.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "slam/slam.hpp"

namespace rover::slam {

struct NodeConfig {
  SlamConfig core;
  Utime latency_us = 100'000;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::slam
