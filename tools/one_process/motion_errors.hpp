// True motions with the errors of visual odometry: a registration of each pair with a keyframe, so errors telescope.
// Fitted to 16,467 motions of 41 rendered drives of default and full_hard, none lost (pose_study --motions).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <random>

#include "visual_odometry/odometry.hpp"

namespace rover {

class MotionErrors {
 public:
  explicit MotionErrors(std::uint64_t seed);

  // Empty for the first pair. T_map_body: true, at the exposure.
  std::optional<vo::OdometryResult> step(Utime utime, const Eigen::Isometry3d& T_map_body);

 private:
  Eigen::Isometry3d registered(const Eigen::Isometry3d& T_key_body);
  Eigen::Vector3d noise(const Eigen::Vector3d& sigma);

  std::mt19937_64 random_;
  double scale_;  // error of the calibration, constant
  Utime keyframe_utime_ = kNever;
  Eigen::Isometry3d T_map_key_;
  Utime previous_utime_ = kNever;
  Eigen::Isometry3d T_map_previous_;  // true
  Eigen::Isometry3d T_key_previous_;  // registered
};

}  // namespace rover
