// config/navigation.yaml: values that several services must agree on.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "common/core/frames.hpp"

namespace rover {

struct NavigationConfig {
  double goal_tolerance_m = 0.5;
  double corridor_half_width_m = 1.5;
  double point_turn_start_rad = to_rad(40.0);
  double point_turn_stop_rad = to_rad(2.0);
  double teleop_max_age_s = 0.5;
  double hazard_roi_near_m = 0.4;
  double hazard_roi_far_m = 3.0;
  double steep_slope_rad = to_rad(10.0);  // both of paths planned or drawn on the orbital map
  double max_slope_rad = to_rad(15.0);
  double cpu_scale = 1.0;
};

NavigationConfig load_navigation(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover
