// Reads config/locomotion.yaml; keys that are absent keep the defaults of the core.
#pragma once

#include <string>

#include "locomotion/locomotion.hpp"

namespace rover::locomotion {

struct NodeConfig {
  LocomotionConfig locomotion;
  Vehicle vehicle;
  double command_validity_s = 0.2;
};

NodeConfig load_config(const std::string& config_dir);

}  // namespace rover::locomotion
