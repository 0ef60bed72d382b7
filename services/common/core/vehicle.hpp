// Geometry and limits of the vehicle (config/vehicle.yaml). SI units, radians.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/core/pan_tilt.hpp"

namespace rover {

// Orders: wheels FL FR ML MR RL RR; steered wheels FL FR RL RR.
inline constexpr std::array<int, 4> kSteeredWheels = {0, 1, 4, 5};

struct Vehicle {
  double origin_height_m = 0.0;  // body origin above flat ground
  double body_mass_kg = 0.0;
  double body_half_length_m = 0.0;
  double body_half_width_m = 0.0;
  double body_top_m = 0.0;
  double belly_clearance_m = 0.0;
  double wheel_radius_m = 0.0;
  double wheel_width_m = 0.0;
  double wheel_mass_kg = 0.0;
  std::array<double, 6> wheel_x_m{};
  std::array<double, 6> wheel_y_m{};
  double steer_max_rad = 0.0;
  double steer_rate_radps = 0.0;
  double steer_current_nominal_a = 0.0;
  double steer_current_limit_a = 0.0;
  double gear_ratio = 0.0;
  double drive_current_nominal_a = 0.0;
  double drive_current_limit_a = 0.0;
  double top_speed_mps = 0.0;
  double deceleration_mps2 = 0.0;
  double min_turn_radius_m = 0.0;
  double max_climb_m = 0.0;
  double hazard_height_m = 0.0;
  Eigen::Vector3d imu_position_m = Eigen::Vector3d::Zero();
  std::optional<PanTiltUnit> pan_tilt;  // none: no NavCam, and so no Full level

  // Half extents of the footprint of wheels and body, about the body origin.
  double footprint_half_length_m() const {
    double x = body_half_length_m;
    for (double wheel : wheel_x_m) x = std::max(x, std::abs(wheel) + wheel_radius_m);
    return x;
  }
  double footprint_half_width_m() const {
    double y = body_half_width_m;
    for (double wheel : wheel_y_m) y = std::max(y, std::abs(wheel) + 0.5 * wheel_width_m);
    return y;
  }
  // Half of the gap between the wheels of both sides.
  double half_gap_m() const {
    double y = footprint_half_width_m();
    for (double wheel : wheel_y_m) y = std::min(y, std::abs(wheel) - 0.5 * wheel_width_m);
    return y;
  }
};

}  // namespace rover
