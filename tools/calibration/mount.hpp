// Mount of a camera, as in cameras.yaml.
#pragma once

#include <Eigen/Geometry>

namespace rover::calibration {

struct Mount {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // in body
  double pitch_down_rad = 0.0;
  double roll_rad = 0.0;
  double yaw_rad = 0.0;
};

// Inverse of make_pose(camera_rotation(pitch_down, roll, yaw), position); pitch must be within +-90 deg.
Mount mount_of(const Eigen::Isometry3d& T_body_left);
Eigen::Isometry3d pose_of(const Mount& mount);

}  // namespace rover::calibration
