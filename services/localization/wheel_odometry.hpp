// Planar wheel odometry.
//
// A wheel at p = (x, y), steered by s, that turned by a rolls r a along (cos s, sin s) without lateral slip. Each wheel
// gives two equations for (dx, dy, dyaw) of the body; least squares solves all twelve (Muir & Neuman, 1987).
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/core/vehicle.hpp"

namespace rover::loc {

class WheelOdometry {
 public:
  explicit WheelOdometry(const Vehicle& vehicle) : vehicle_(vehicle) {}

  // Forward kinematics: (dx, dy, dyaw) of the body.
  Eigen::Vector3d body_motion(const std::array<double, 6>& wheel_turn_rad,
                              const std::array<double, 4>& steer_rad) const;

  // Inverse kinematics: distance each wheel rolls along its own direction for (dx, dy, dyaw) without slip.
  std::array<double, 6> wheel_travel_m(const Eigen::Vector3d& motion, const std::array<double, 4>& steer_rad) const;

  // Mean of |r a| over the six wheels.
  double path_m(const std::array<double, 6>& wheel_turn_rad) const;

 private:
  Vehicle vehicle_;
};

}  // namespace rover::loc
