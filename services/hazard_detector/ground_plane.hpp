// Robust ground plane fit: exhaustive (deterministic) search for the plane with most inliers, refined by iteratively
// reweighted least squares with Tukey weights. Slope and offset at the front axle are bounded, because the rover is
// on the ground. Cells below a plane reduce its score, so that the top of a rock is not fitted as ground.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

// z = offset_m - origin_height_m + slope_x (x - front axle) + slope_y y, body frame.
struct GroundPlane {
  double offset_m = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  bool measured = false;  // false: too few cells, this is the prior (flat ground)

  Eigen::Vector3d normal() const { return Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized(); }
  // Pitch is positive if the ground falls away ahead, roll if it rises to the left.
  double pitch_rad() const { return -std::atan(slope_x); }
  double roll_rad() const { return std::atan(slope_y); }
};

// Mean of a cell in the body frame; z is relative to flat ground under the rover.
struct GroundPoint {
  float x_m, y_m, z_m;
};
using GroundPoints = std::vector<GroundPoint>;

GroundPlane fit_ground_plane(const GroundPoints& points, const PlanePrior& prior);

}  // namespace rover::hazard
