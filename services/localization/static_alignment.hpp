// Static alignment of a stationary rover: roll and pitch from the mean specific force (gravity), gyro bias from the
// mean angular rate.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "localization/motion_history.hpp"

namespace rover::loc {

struct StaticAlignmentConfig {
  double duration_s = 10.0;       // of standstill; also sets how well the gyro bias, and later the heading, is known
  double min_gravity_mps2 = 1.0;  // accepted magnitude of the mean specific force: Mars 3.7, Earth 9.8
  double max_gravity_mps2 = 12.0;
};

struct StaticAlignmentResult {
  Eigen::Matrix3d R_odom_body;  // yaw 0
  Eigen::Vector3d gyro_bias_radps;
  double gravity_mps2;
};

class StaticAlignment {
 public:
  explicit StaticAlignment(const StaticAlignmentConfig& config) : config_(config) {}
  // The result once the rover was stationary for duration_s; any motion restarts the averaging.
  std::optional<StaticAlignmentResult> add(const MotionRecord& record);

 private:
  StaticAlignmentConfig config_;
  double time_s_ = 0.0;
  Eigen::Vector3d velocity_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angle_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace rover::loc
