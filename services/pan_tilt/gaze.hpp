// Viewing direction of the NavCam.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace rover::gaze {

// Pan-tilt angles: pan positive to the left, tilt positive down.
struct Gaze {
  double pan_rad = 0.0;
  double tilt_rad = 0.0;
};

using Path = std::vector<Eigen::Vector2d>;  // in odom [m]

}  // namespace rover::gaze
