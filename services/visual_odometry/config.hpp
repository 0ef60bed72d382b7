// config/visual_odometry.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "visual_odometry/odometry.hpp"

namespace rover::vo {

struct NodeConfig {
  OdometryConfig odometry;
  double latency_s = 0.12;  // modelled processing time, from the disparity to the motion
  double gyro_history_s = 30.0;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::vo
