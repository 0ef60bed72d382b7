#include "slam/map_anchor.hpp"

#include <algorithm>
#include <cmath>

#include "slam/particle_filter.hpp"

namespace rover::slam {
namespace {

constexpr double kMaxGapS = 1.0;  // between two POSE of a SLAM that runs

}  // namespace

bool MapAnchor::add_pose(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body) {
  const Pose2 T_new = planar(T_map_odom), T_old = T_map_odom_;
  // After a pause of SLAM's own anything can have changed; an anchor too many does no harm.
  const double dt_s = std::min(kMaxGapS, to_seconds(utime - utime_));
  const bool known = utime_ != kNever;
  utime_ = utime;
  T_map_odom_ = T_new;
  if (!known) return false;
  const Pose2 body = planar(T_odom_body), after = compose(T_new, body), before = compose(T_old, body);
  return std::hypot(after.x_m - before.x_m, after.y_m - before.y_m) > config_.slew_mps * dt_s + config_.tolerance_m ||
         std::abs(wrap_angle(after.yaw_rad - before.yaw_rad)) > config_.slew_radps * dt_s + config_.tolerance_rad;
}

void MapAnchor::anchor(const Pose2& T_slam_odom) {
  T_map_slam_ = compose(T_map_odom_, between(T_slam_odom, Pose2{}));
}

void MapAnchor::restore(const State& state) {
  utime_ = state.utime;
  T_map_odom_ = state.T_map_odom;
  T_map_slam_ = state.T_map_slam;
}

Pose2 MapAnchor::T_map_odom(const Pose2& T_slam_odom) const {
  return compose(*T_map_slam_, T_slam_odom);
}

}  // namespace rover::slam
