#include "pan_tilt/look_ahead.hpp"

#include <algorithm>
#include <cmath>

namespace rover::gaze {
namespace {

constexpr double kMinTargetDistanceM = 0.5;  // a nearer target has no meaningful direction

// Parameter 0 .. 1 of the point on segment a-b nearest to `position`.
double projection_fraction(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& position) {
  const double squared = (b - a).squaredNorm();
  return squared > 0.0 ? std::clamp((position - a).dot(b - a) / squared, 0.0, 1.0) : 0.0;
}

double pan_towards(const Eigen::Vector2d& target, const Pose2& body, const CameraMount& mount) {
  const Eigen::Vector2d from_origin = target - Eigen::Vector2d(body.x_m, body.y_m);
  Eigen::Vector2d in_body = Eigen::Rotation2Dd(-body.yaw_rad) * from_origin;
  in_body.x() -= mount.pan_axis_x_m;
  return in_body.norm() < kMinTargetDistanceM ? 0.0 : std::atan2(in_body.y(), in_body.x());
}

}  // namespace

Eigen::Vector2d lookahead_point(const Path& path, const Eigen::Vector2d& position, double distance_m) {
  size_t segment = 0;
  Eigen::Vector2d point = path.front();
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    const Eigen::Vector2d p = path[i] + projection_fraction(path[i], path[i + 1], position) * (path[i + 1] - path[i]);
    if ((p - position).norm() >= (point - position).norm()) continue;
    point = p;
    segment = i;
  }
  double remaining_m = distance_m;
  for (size_t i = segment + 1; i < path.size(); ++i) {
    const double step_m = (path[i] - point).norm();
    if (step_m > remaining_m) return point + remaining_m / step_m * (path[i] - point);
    remaining_m -= step_m;
    point = path[i];
  }
  return point;
}

Gaze look_ahead(const Path& path, const Pose2& body_odom, const CameraMount& mount, const LookAheadConfig& config) {
  Gaze gaze;
  const double middle = 0.5 * (std::atan2(mount.height_m, config.near_m) + std::atan2(mount.height_m, config.far_m));
  gaze.tilt_rad = middle - mount.pitch_down_rad;
  if (path.size() < 2) return gaze;
  const Eigen::Vector2d target = lookahead_point(path, {body_odom.x_m, body_odom.y_m}, config.distance_m);
  gaze.pan_rad = std::clamp(pan_towards(target, body_odom, mount), -config.pan_max_rad, config.pan_max_rad);
  return gaze;
}

}  // namespace rover::gaze
