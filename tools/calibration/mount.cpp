#include "tools/calibration/mount.hpp"

#include "common/core/frames.hpp"

namespace rover::calibration {

Mount mount_of(const Eigen::Isometry3d& T_body_left) {
  const Eigen::Matrix3d R_level_cam = camera_rotation(0.0);
  const Eigen::Vector3d rpy = rpy_of(T_body_left.linear() * R_level_cam.transpose());
  return {T_body_left.translation(), rpy.y(), rpy.x(), rpy.z()};
}

Eigen::Isometry3d pose_of(const Mount& mount) {
  return make_pose(camera_rotation(mount.pitch_down_rad, mount.roll_rad, mount.yaw_rad), mount.position_m);
}

}  // namespace rover::calibration
