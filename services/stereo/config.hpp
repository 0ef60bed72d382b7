// config/stereo.yaml, config/cameras.yaml and config/vehicle.yaml into what the core needs.
#pragma once

#include <string>

#include "common/core/time.hpp"
#include "common/stereo/stereo.hpp"

namespace rover::stereo {

struct NodeConfig {
  StereoConfig core;
  StereoRig rig;
  double ground_below_m = 0.0;  // of the body origin
  Utime latency_us = 120'000;
};

NodeConfig load_config(const std::string& config_dir);

}  // namespace rover::stereo
