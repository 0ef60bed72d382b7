// Roll, pitch and gyro bias of a rover that stands: the mean specific force points up.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "localization/motion_history.hpp"

namespace rover::loc {

struct LevellingConfig {
  double duration_s = 10.0;  // of standing; the gyros' biases, on which the heading drifts later, are known as well
  double min_gravity_mps2 = 1.0;  // the mean specific force is taken as gravity: Mars 3.7, Earth 9.8
  double max_gravity_mps2 = 12.0;
};

struct Level {
  Eigen::Matrix3d R_odom_body;  // yaw 0
  Eigen::Vector3d gyro_bias_radps;
  double gravity_mps2;
};

class Levelling {
 public:
  explicit Levelling(const LevellingConfig& config) : config_(config) {}
  // The level once the rover has stood long enough; any motion begins anew.
  std::optional<Level> add(const MotionRecord& record);

 private:
  LevellingConfig config_;
  double time_s_ = 0.0;
  Eigen::Vector3d velocity_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angle_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace rover::loc
