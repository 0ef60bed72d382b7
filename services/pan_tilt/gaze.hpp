// Where the NavCam looks.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace rover::gaze {

// Angles of the unit: pan positive to the left, tilt positive down.
struct Gaze {
  double pan_rad = 0.0;
  double tilt_rad = 0.0;
};

using Path = std::vector<Eigen::Vector2d>;  // in odom [m]

}  // namespace rover::gaze
