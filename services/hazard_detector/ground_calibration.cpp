#include "hazard_detector/ground_calibration.hpp"

#include "common/core/frames.hpp"

namespace rover::hazard {
namespace {

Eigen::Vector3d mount_rpy(const StereoCamera& camera) {
  return rpy_of(camera.T_body_cam.linear() * camera_rotation(0.0).transpose());
}

}  // namespace

GroundCalibration nominal_calibration(const StereoCamera& camera, double origin_height_m) {
  const Eigen::Vector3d rpy = mount_rpy(camera);
  return {camera.T_body_cam.translation().z() + origin_height_m, rpy.y(), rpy.x()};
}

StereoCamera calibrated_camera(StereoCamera camera, const GroundCalibration& calibration, double origin_height_m) {
  const double yaw_rad = mount_rpy(camera).z();
  camera.T_body_cam.linear() = camera_rotation(calibration.pitch_rad, calibration.roll_rad, yaw_rad);
  camera.T_body_cam.translation().z() = calibration.height_m - origin_height_m;
  return camera;
}

}  // namespace rover::hazard
