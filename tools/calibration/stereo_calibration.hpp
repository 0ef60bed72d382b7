// What a calibration tool finds out about a stereo camera.
#pragma once

#include <optional>

#include "common/core/camera_rig.hpp"

namespace rover::calibration {

struct StereoCalibration {
  int width = 0;  // 0: not in the file
  int height = 0;
  PinholeCamera left;
  PinholeCamera right;
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();  // right camera in left camera axes
  std::optional<Eigen::Isometry3d> T_left_imu;  // the IMU in left camera axes, where it was calibrated
};

}  // namespace rover::calibration
