#include "common/bus/convert.hpp"

#include <algorithm>
#include <cmath>

namespace rover {

Eigen::Isometry3d pose_from(const double position_m[3], const double quat_wxyz[4]) {
  constexpr double kMaxNormError = 1e-3;
  const Eigen::Quaterniond q(quat_wxyz[0], quat_wxyz[1], quat_wxyz[2], quat_wxyz[3]);
  if (!(std::abs(q.norm() - 1.0) <= kMaxNormError)) return nan_pose();  // damaged: normalised it would be any attitude
  return make_pose(q.normalized().toRotationMatrix(), {position_m[0], position_m[1], position_m[2]});
}

void pose_to(const Eigen::Isometry3d& T, double position_m[3], double quat_wxyz[4]) {
  Eigen::Quaterniond q(T.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  for (int i = 0; i < 3; ++i) position_m[i] = T.translation()[i];
  quat_wxyz[0] = q.w();
  quat_wxyz[1] = q.x();
  quat_wxyz[2] = q.y();
  quat_wxyz[3] = q.z();
}

Matrix6d matrix6_from(const double values[36]) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values);
}

void matrix6_to(const Matrix6d& m, double values[36]) {
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> out(values);
  out = m;
}

namespace {

bool size_fits(int width, int height, std::int64_t size) {
  return width > 0 && height > 0 && static_cast<std::int64_t>(width) * height == size;
}

}  // namespace

GrayImage image_from(const image_t& message) {
  if (message.encoding != image_t::MONO8 || !size_fits(message.width, message.height, message.size)) return {};
  GrayImage image(message.width, message.height);
  std::copy(message.data.begin(), message.data.end(), image.data.begin());
  return image;
}

void image_to(const GrayImage& image, image_t& message) {
  message.width = static_cast<std::int16_t>(image.width);
  message.height = static_cast<std::int16_t>(image.height);
  message.encoding = image_t::MONO8;
  message.size = static_cast<std::int32_t>(image.data.size());
  message.data.assign(image.data.begin(), image.data.end());
}

Disparity disparity_from(const disparity_t& message) {
  if (!size_fits(message.width, message.height, message.size)) return {};
  Disparity disparity(message.width, message.height);
  disparity.px16 = message.disparity_px16;
  return disparity;
}

StereoCamera camera_from(const disparity_t& message) {
  return {message.width,
          message.height,
          message.focal_px,
          message.cx_px,
          message.cy_px,
          message.baseline_m,
          pose_from(message.position_body_cam_m, message.quat_body_cam_wxyz)};
}

void disparity_to(const Disparity& disparity, const StereoCamera& camera, disparity_t& message) {
  message.width = static_cast<std::int16_t>(disparity.width);
  message.height = static_cast<std::int16_t>(disparity.height);
  message.focal_px = camera.focal_px;
  message.cx_px = camera.cx_px;
  message.cy_px = camera.cy_px;
  message.baseline_m = camera.baseline_m;
  pose_to(camera.T_body_cam, message.position_body_cam_m, message.quat_body_cam_wxyz);
  const auto valid = std::count_if(disparity.px16.begin(), disparity.px16.end(), [](auto d) { return d > 0; });
  message.valid_fraction = static_cast<float>(valid) / static_cast<float>(std::max<size_t>(1, disparity.px16.size()));
  message.size = static_cast<std::int32_t>(disparity.px16.size());
  message.disparity_px16 = disparity.px16;
}

MotionCommand command_from(const motion_command_t& message) {
  MotionCommand out;
  out.utime = message.header.utime;
  out.valid_until = message.valid_until_utime;
  if (message.mode == motion_command_t::ARC) out.mode = MotionMode::kArc;
  if (message.mode == motion_command_t::POINT_TURN) out.mode = MotionMode::kPointTurn;
  out.speed_mps = message.speed_mps;
  out.curvature_per_m = message.curvature_per_m;
  out.turn_rate_radps = message.turn_rate_radps;
  return out;
}

DrivePermit permit_from(const drive_permit_t& message) {
  return {message.header.utime, message.valid_until_utime, message.granted == 1, message.max_speed_mps};
}

}  // namespace rover
