#include "localization/static_alignment.hpp"

#include <cmath>

#include "common/core/frames.hpp"

namespace rover::loc {

std::optional<StaticAlignmentResult> StaticAlignment::add(const MotionRecord& record) {
  if (!record.stationary || !record.force_valid || !record.gyro_valid) {
    *this = StaticAlignment(config_);
    return std::nullopt;
  }
  time_s_ += record.dt_s();
  velocity_sum_ += record.delta_velocity_mps;
  angle_sum_ += record.delta_angle_rad;
  if (time_s_ < config_.duration_s) return std::nullopt;
  const Eigen::Vector3d force = velocity_sum_ / time_s_;
  const Eigen::Vector3d bias = angle_sum_ / time_s_;
  *this = StaticAlignment(config_);
  const double gravity = force.norm();
  if (gravity < config_.min_gravity_mps2 || gravity > config_.max_gravity_mps2) return std::nullopt;
  const double roll = std::atan2(force.y(), force.z());
  const double pitch = std::atan2(-force.x(), std::hypot(force.y(), force.z()));
  return StaticAlignmentResult{rotation_from_rpy(roll, pitch, 0.0), bias, gravity};
}

}  // namespace rover::loc
