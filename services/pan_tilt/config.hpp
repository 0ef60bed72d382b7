// Reads config/pan_tilt.yaml, the unit in vehicle.yaml and the NavCam in cameras.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "pan_tilt/pan_tilt.hpp"

namespace rover::gaze {

struct NodeConfig {
  PanTiltConfig core;
  PanTiltUnit unit;
  CameraMount mount;
  double max_state_age_s = 1.0;  // of the supervisor's STATE; older: idle
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::gaze
