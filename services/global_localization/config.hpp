// config/global_localization.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "global_localization/attempt_schedule.hpp"
#include "global_localization/global_localization.hpp"

namespace rover::global {

struct NodeConfig {
  Utime latency_us = 500'000;
  double max_map_age_s = 2.0;
  double max_pose_age_s = 0.5;
  double local_cell_m = 0.1;  // cell size of ELEVATION
  double max_jump_m = 0.5;    // position change in odom beyond the distance driven
  ScheduleConfig attempts;
  GlobalConfig core;
};

NodeConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::global
