// Planar motion of the body from the turning of its wheels.
//
// A wheel at p = (x, y), steered by s, that turned by a rolls r a along (cos s, sin s) and slides nothing across. Each
// gives two equations for (dx, dy, dyaw) of the body; all twelve are solved in least squares (Muir & Neuman, 1987).
#pragma once

#include <Eigen/Core>
#include <array>

#include "common/core/vehicle.hpp"

namespace rover::loc {

class WheelOdometry {
 public:
  explicit WheelOdometry(const Vehicle& vehicle) : vehicle_(vehicle) {}

  // (dx, dy, dyaw) of the body for wheel turns [rad] at the steering angles.
  Eigen::Vector3d motion(const std::array<double, 6>& turned_rad, const std::array<double, 4>& steer_rad) const;

  // How far each wheel would roll along its own direction were the body to move by (dx, dy, dyaw) without slip.
  std::array<double, 6> rolled_m(const Eigen::Vector3d& motion, const std::array<double, 4>& steer_rad) const;

  // Mean length rolled, whichever way: |r a| over the six wheels.
  double path_m(const std::array<double, 6>& turned_rad) const;

  double wheel_radius_m() const { return vehicle_.wheel_radius_m; }

 private:
  Vehicle vehicle_;
};

}  // namespace rover::loc
