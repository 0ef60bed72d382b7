// Reads config/point_cloud.yaml, the NavCam in cameras.yaml and the pan-tilt unit in vehicle.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "point_cloud/point_cloud.hpp"

namespace rover::cloud {

struct NodeConfig {
  PointCloudConfig core;
  StereoRig rig;
  PanTiltUnit unit;
  double ground_below_m = 0.0;  // below the body origin
  Utime latency_us = 200'000;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::cloud
