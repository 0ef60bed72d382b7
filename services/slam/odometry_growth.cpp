#include "slam/odometry_growth.hpp"

namespace rover::slam {

void OdometryGrowth::add(const pose_t& pose, Odometry& odometry) {
  if (last_) {
    before_m_ = last_->dead_reckoned_m + (odometry.T_odom_body.translation() - last_->T_odom_body.translation()).norm();
    position_.restart(odometry.position_sigma_m, last_->position_sigma_m);
    yaw_.restart(odometry.yaw_sigma_rad, last_->yaw_sigma_rad);
    last_.reset();
  }
  const bool next_tick = pose.header.utime - utime_ <= kTickUs;
  utime_ = pose.header.utime;
  odometry.dead_reckoned_m = before_m_ + dead_reckoned_.add(pose);
  odometry.position_sigma_m = position_.add(odometry.position_sigma_m, next_tick);
  odometry.yaw_sigma_rad = yaw_.add(odometry.yaw_sigma_rad, next_tick);
}

}  // namespace rover::slam
