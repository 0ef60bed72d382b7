// Reads config/stereo.yaml, config/cameras.yaml and config/vehicle.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "common/stereo/stereo.hpp"

namespace rover::stereo {

struct NodeConfig {
  StereoConfig core;
  StereoRig rig;
  double origin_height_m = 0.0;  // height of the body origin above flat ground
  Utime latency_us = 120'000;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::stereo
