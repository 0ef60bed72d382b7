// Looks along the path as it bends.
#pragma once

#include "common/core/frames.hpp"
#include "pan_tilt/gaze.hpp"

namespace rover::gaze {

struct LookAheadConfig {
  double distance_m = 4.0;  // along the path
  double pan_max_rad = to_rad(60.0);
  double near_m = 2.0;  // of the ground that shall be seen, before the camera
  double far_m = 8.0;
};

// The camera over flat ground at pan and tilt zero.
struct CameraMount {
  double height_m = 0.0;
  double pitch_down_rad = 0.0;
  double axes_x_m = 0.0;  // of the pan axis, before the body's origin
};

// Point of the path that lies `distance_m` along it from where it is nearest to the place; its end where it is shorter.
// The path has at least two points.
Eigen::Vector2d point_ahead(const Path& path, const Eigen::Vector2d& place, double distance_m);

// Straight ahead where there is no path, or no way to go on it.
Gaze look_ahead(const Path& path, const Pose2& body_odom, const CameraMount& mount, const LookAheadConfig& config);

}  // namespace rover::gaze
