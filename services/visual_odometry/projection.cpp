#include "visual_odometry/projection.hpp"

namespace rover::vo {

Eigen::Vector3d project(const StereoCamera& camera, const Eigen::Vector3d& p_cam) {
  const double f_z = camera.focal_px / p_cam.z();
  const double u = camera.cx_px + f_z * p_cam.x();
  return {u, camera.cy_px + f_z * p_cam.y(), u - f_z * camera.baseline_m};
}

Eigen::Matrix3d project_jacobian(const StereoCamera& camera, const Eigen::Vector3d& p_cam) {
  const double f_z = camera.focal_px / p_cam.z();
  const double f_z2 = f_z / p_cam.z();
  Eigen::Matrix3d J;
  J << f_z, 0.0, -f_z2 * p_cam.x(),  //
      0.0, f_z, -f_z2 * p_cam.y(),   //
      f_z, 0.0, -f_z2 * (p_cam.x() - camera.baseline_m);
  return J;
}

}  // namespace rover::vo
