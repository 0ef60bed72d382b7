#include "slam/map_anchor.hpp"

#include <cmath>

#include "slam/particle_filter.hpp"

namespace rover::slam {

bool MapAnchor::take(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body) {
  const Pose2 now = planar(T_map_odom), before = T_map_odom_;
  const double s = to_seconds(utime - utime_);
  const bool known = utime_ != kNever;
  utime_ = utime;
  T_map_odom_ = now;
  if (!known) return false;
  const Pose2 body = planar(T_odom_body), there = compose(now, body), was = compose(before, body);
  return std::hypot(there.x_m - was.x_m, there.y_m - was.y_m) > config_.slow_mps * s + config_.slack_m ||
         std::abs(wrap_angle(there.yaw_rad - was.yaw_rad)) > config_.slow_radps * s + config_.slack_rad;
}

void MapAnchor::anchor(const Pose2& T_slam_odom) {
  T_map_slam_ = compose(T_map_odom_, between(T_slam_odom, Pose2{}));
}

Pose2 MapAnchor::T_map_odom(const Pose2& T_slam_odom) const {
  return compose(*T_map_slam_, T_slam_odom);
}

}  // namespace rover::slam
