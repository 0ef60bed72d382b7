#include "slam/convert.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::slam {
namespace {

constexpr float kMaxRangeM = 100.0F;
constexpr int kMaxPoints = 400'000;

bool is_valid(float x, float y, float z, float sigma) {
  return std::abs(x) < kMaxRangeM && std::abs(y) < kMaxRangeM && z > 0.0F && z < kMaxRangeM && sigma > 0.0F &&
         sigma < kMaxRangeM;
}

}  // namespace

std::string fault_of(const cloud_t& message) {
  double squares = 0.0;
  for (const double q : message.quat_body_cam_wxyz) squares += q * q;
  bool mount_valid = std::abs(squares - 1.0) < 1e-3;
  for (const double p : message.position_body_cam_m) mount_valid = mount_valid && std::abs(p) < 10.0;
  if (!mount_valid) return "camera's mount is not usable";
  if (message.point_count > kMaxPoints) return "more points than a camera has";
  if (message.picture_size != 0 && message.picture_size != message.point_count)
    return "its brightness does not belong to its points";
  for (size_t i = 0; i < message.x_m.size(); ++i)
    if (!is_valid(message.x_m[i], message.y_m[i], message.z_m[i], message.depth_sigma_m[i]))
      return "point " + std::to_string(i) + " is not finite or out of range";
  return "";
}

Cloud cloud_from(const cloud_t& message) {
  Cloud cloud;
  cloud.utime = message.header.utime;
  cloud.T_body_cam = pose_from(message.position_body_cam_m, message.quat_body_cam_wxyz);
  cloud.points.reserve(message.x_m.size());
  for (size_t i = 0; i < message.x_m.size(); ++i)
    cloud.points.push_back({{message.x_m[i], message.y_m[i], message.z_m[i]}, message.depth_sigma_m[i]});
  for (size_t i = 0; i < message.brightness.size(); ++i)
    if (std::isfinite(message.brightness[i])) cloud.points[i].brightness = message.brightness[i];
  return cloud;
}

bool usable(const pose_t& message) {
  const PoseSample sample = sample_from(message);
  return message.status != pose_t::UNINITIALISED && is_finite(sample.odometry.T_odom_body) &&
         is_finite(sample.T_map_odom) && std::isfinite(sample.odometry.position_sigma_m) &&
         std::isfinite(sample.odometry.yaw_sigma_rad);
}

PoseSample sample_from(const pose_t& message) {
  const Matrix6d cov = matrix6_from(message.covariance);
  PoseSample sample;
  sample.utime = message.header.utime;
  sample.odometry.T_odom_body = pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  sample.odometry.position_sigma_m = std::sqrt(std::max(cov(0, 0), cov(1, 1)));
  sample.odometry.yaw_sigma_rad = std::sqrt(cov(5, 5));
  sample.odometry.travelled_m = message.travelled_m;
  sample.T_map_odom = pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz);
  return sample;
}

void elevation_to(const OdomElevation& elevation, elevation_t& message) {
  message.cell_m = elevation.cell_m;
  message.origin_x_m = elevation.corner.ix * elevation.cell_m;
  message.origin_y_m = elevation.corner.iy * elevation.cell_m;
  message.cells_x = message.cells_y = static_cast<std::int16_t>(elevation.cells);
  message.size = elevation.cells * elevation.cells;
  message.height_m = elevation.height_m;
  message.sigma_m = elevation.sigma_m;
  message.picture_size = static_cast<std::int32_t>(elevation.brightness.size());
  message.brightness = elevation.brightness;
}

void slam_pose_to(const SlamResult& result, slam_pose_t& message) {
  message.status = static_cast<std::int8_t>(result.status);
  message.x_m = result.T_map_odom.x_m;
  message.y_m = result.T_map_odom.y_m;
  message.yaw_rad = result.T_map_odom.yaw_rad;
  message.drift_x_m = result.T_slam_odom.x_m;
  message.drift_y_m = result.T_slam_odom.y_m;
  message.drift_yaw_rad = result.T_slam_odom.yaw_rad;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) message.covariance[3 * row + column] = result.covariance(row, column);
  message.information = result.information;
  message.particles = result.particles;
}

}  // namespace rover::slam
