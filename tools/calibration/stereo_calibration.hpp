// Result of a stereo calibration.
#pragma once

#include <optional>

#include "common/core/camera_rig.hpp"

namespace rover::calibration {

struct StereoCalibration {
  int width = 0;  // 0: not in the file
  int height = 0;
  PinholeCamera left;
  PinholeCamera right;
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();  // right camera in the left camera's axes
  std::optional<Eigen::Isometry3d> T_left_imu;                     // IMU in the left camera's axes, if calibrated
};

}  // namespace rover::calibration
