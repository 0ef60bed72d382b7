// config/@NAME@.yaml.
#pragma once

#include <string>

#include "@NAME@/@NAME@.hpp"
#include "common/bus/parameters.hpp"

namespace rover::@NAME@ {

struct NodeConfig {
  @CLASS@Config core;
  double max_pose_age_s = 0.5;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::@NAME@
