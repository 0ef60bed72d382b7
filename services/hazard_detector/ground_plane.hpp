// The plane of the ground ahead. The rover stands on the ground, so the plane starts near the wheels: its slope and its
// offset at the wheel line are bounded. Within the bounds an exhaustive search finds the plane with most supporters,
// and cells below a plane count against it (ground has rocks above it, rarely holes), so a rock's top cannot become
// ground; an iteratively reweighted fit refines it. Nothing is drawn at random.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

// z = offset_m - ground_below + slope_x (x - wheel line) + slope_y y, body axes.
struct GroundPlane {
  double offset_m = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  bool measured = false;  // false: the prior

  Eigen::Vector3d normal() const { return Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized(); }
  // As rotations of the body: pitch positive where the ground falls away ahead.
  double pitch_rad() const { return -std::atan(slope_x); }
  double roll_rad() const { return std::atan(slope_y); }
};

// Mean of a cell in body axes, z counted from flat ground under the rover.
struct GroundPoint {
  float x_m, y_m, z_m;
};
using GroundPoints = std::vector<GroundPoint>;

GroundPlane fit_ground_plane(const GroundPoints& points, const PlanePrior& prior);

}  // namespace rover::hazard
