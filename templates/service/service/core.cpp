#include "@NAME@/@NAME@.hpp"

namespace rover::@NAME@ {

double @CLASS@::step(const Eigen::Vector3d& p_odom_body_m) {
  if (!last_m_) last_m_ = p_odom_body_m;
  const double step_m = (p_odom_body_m - *last_m_).norm();
  if (step_m >= config_.min_step_m) {
    distance_m_ += step_m;
    last_m_ = p_odom_body_m;
  }
  return distance_m_;
}

}  // namespace rover::@NAME@
