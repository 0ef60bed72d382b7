// What the LocCam sees of the ground, by the calibration of its cameras.
#pragma once

#include "common/core/camera_rig.hpp"
#include "path_planner/geometry.hpp"

namespace rover::planning {

// A trapezoid ahead of the body origin.
struct ViewArea {
  Point2 camera{0.53, 0.07};  // an obstacle hides what lies behind it from here
  double near_m = 0.92;
  double far_m = 3.9;
  double near_half_width_m = 0.37;
  double far_half_width_m = 1.8;

  bool sees(Point2 in_body) const {
    if (in_body.x_m < near_m || in_body.x_m > far_m) return false;
    const double u = (in_body.x_m - near_m) / (far_m - near_m);
    return std::abs(in_body.y_m) <= near_half_width_m + u * (far_half_width_m - near_half_width_m);
  }
};

// Flat ground, `ground_z_m` above the body origin, that both cameras see with a block of the disparity around it, as
// far as `far_m` ahead; without any the half widths are negative.
ViewArea view_of(const StereoRig& rig, double ground_z_m, double far_m);

}  // namespace rover::planning
