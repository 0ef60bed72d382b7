#include "visual_odometry/convert.hpp"

#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::vo {
namespace {

int8_t status_code(Status status) {
  static constexpr std::int8_t kCodes[] = {vo_motion_t::OK, vo_motion_t::DEGRADED, vo_motion_t::LOST,
                                           vo_motion_t::DISPLACED};
  return kCodes[static_cast<int>(status)];
}

}  // namespace

GyroIncrement gyro_from(const imu_t& message) {
  GyroIncrement increment;
  increment.utime = message.header.utime;
  increment.dt_s = message.dt_s;
  increment.delta_angle_rad = Eigen::Vector3d(message.delta_angle_rad);
  if (std::isfinite(message.fog_delta_yaw_rad)) increment.delta_angle_rad.z() = message.fog_delta_yaw_rad;
  return increment;
}

bool is_valid(const StereoCamera& camera) {
  const double numbers = camera.focal_px + camera.cx_px + camera.cy_px + camera.baseline_m;
  const Eigen::Matrix3d R = camera.T_body_cam.linear();
  return std::isfinite(numbers) && is_finite(camera.T_body_cam) && camera.focal_px > 1.0 && camera.baseline_m > 1e-3 &&
         (R * R.transpose()).isIdentity(1e-6);
}

bool sizes_match(const StereoFrame& frame) {
  const int w = frame.left.width;
  const int h = frame.left.height;
  return w >= 32 && h >= 32 && frame.right.width == w && frame.right.height == h && frame.camera.width == w &&
         frame.camera.height == h && frame.disparity->width == w && frame.disparity->height == h;
}

void motion_to(const OdometryResult& result, vo_motion_t& message) {
  message.previous_utime = result.previous_utime;
  message.keyframe_utime = result.keyframe_utime;
  pose_to(result.T_prev_cur, message.position_m, message.quat_wxyz);
  matrix6_to(result.cov, message.covariance);
  message.status = status_code(result.status);
  message.features = result.features;
  message.inliers = result.inliers;
  message.reprojection_rms_px = result.rms_px;
}

}  // namespace rover::vo
