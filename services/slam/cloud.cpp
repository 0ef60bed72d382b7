#include "slam/cloud.hpp"

namespace rover::slam {

AlignedCloud align_to_gravity(const Cloud& cloud, const Eigen::Isometry3d& T_odom_body, const AttitudeNoise& noise) {
  const Eigen::Vector3d rpy = rpy_of(T_odom_body.linear());
  const Eigen::Isometry3d T_level_body = make_pose(rotation_from_rpy(rpy.x(), rpy.y(), 0.0), Eigen::Vector3d::Zero());
  const Eigen::Isometry3f T_level_cam = (T_level_body * cloud.T_body_cam).cast<float>();
  const auto tilt2 = static_cast<float>(noise.tilt_rad * noise.tilt_rad);
  const auto height2 = static_cast<float>(noise.height_m * noise.height_m);
  AlignedCloud aligned;
  aligned.camera_m = T_level_cam.translation();
  aligned.points.reserve(cloud.points.size());
  for (const CameraPoint& point : cloud.points) {
    const Eigen::Vector3f p = T_level_cam * point.p_cam_m;
    // A depth error moves the point along its ray.
    const Eigen::Vector3f along = T_level_cam.linear() * point.p_cam_m * (point.depth_sigma_m / point.p_cam_m.z());
    const float variance = along.z() * along.z() + tilt2 * p.head<2>().squaredNorm() + height2;
    aligned.points.push_back({p.x(), p.y(), p.z(), variance, along.x(), along.y(), point.brightness});
  }
  return aligned;
}

}  // namespace rover::slam
