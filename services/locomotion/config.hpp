// Describes and reads config/locomotion.yaml; geometry and limits come from config/vehicle.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "locomotion/locomotion.hpp"

namespace rover::locomotion {

struct NodeConfig {
  LocomotionConfig locomotion;
  Vehicle vehicle;
  double command_validity_s = 0.2;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::locomotion
