// Viewing direction towards a lookahead point on the path.
#pragma once

#include "common/core/frames.hpp"
#include "pan_tilt/gaze.hpp"

namespace rover::gaze {

struct LookAheadConfig {
  double distance_m = 4.0;  // along the path
  double pan_max_rad = to_rad(60.0);
  double near_m = 2.0;  // ground to be seen, from the camera
  double far_m = 8.0;
};

// The camera above flat ground at pan and tilt zero.
struct CameraMount {
  double height_m = 0.0;
  double pitch_down_rad = 0.0;
  double pan_axis_x_m = 0.0;  // pan axis relative to the body's origin
};

// Point `distance_m` along the path from its point nearest to `position`, or the path's end. Needs at least two points.
Eigen::Vector2d lookahead_point(const Path& path, const Eigen::Vector2d& position, double distance_m);

// Straight ahead without a path or at its end.
Gaze look_ahead(const Path& path, const Pose2& body_odom, const CameraMount& mount, const LookAheadConfig& config);

}  // namespace rover::gaze
