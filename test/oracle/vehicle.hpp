// The vehicle of config/vehicle.yaml, as far as the oracle uses it.
#pragma once

#include "common/core/vehicle.hpp"

namespace rover::oracle {

inline Vehicle test_vehicle() {
  Vehicle vehicle;
  vehicle.body_half_length_m = 0.60;
  vehicle.body_half_width_m = 0.30;
  vehicle.wheel_radius_m = 0.125;
  vehicle.wheel_width_m = 0.12;
  vehicle.wheel_x_m = {0.75, 0.75, 0.0, 0.0, -0.75, -0.75};
  vehicle.wheel_y_m = {0.41, -0.41, 0.41, -0.41, 0.41, -0.41};
  vehicle.min_turn_radius_m = 1.0;
  vehicle.max_climb_m = 0.20;
  vehicle.hazard_height_m = 0.15;
  return vehicle;
}

}  // namespace rover::oracle
