// In place of a vehicle: six wheels that do at once what they are told, nearly, on level ground without slip.
// A real driver has motors and sensors here.
#pragma once

#include <array>
#include <optional>
#include <random>
#include <rover/imu_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/core/frames.hpp"
#include "common/core/vehicle.hpp"

namespace example {

class PlaneRover {
 public:
  PlaneRover(const rover::Vehicle& vehicle, const rover::Pose2& start) : vehicle_(vehicle), pose_(start) {}

  // Moves for dt under the command; without one the wheels come to rest and the steering stays.
  void step(const std::optional<rover::wheel_command_t>& command, double dt_s);

  // Of the last step: increments in body axes.
  rover::imu_t imu();
  rover::wheel_state_t wheels(bool command_expired) const;
  const rover::Pose2& pose() const { return pose_; }

 private:
  struct Twist {
    double forward_mps = 0.0;
    double left_mps = 0.0;
    double turn_radps = 0.0;
  };
  Twist rolling() const;
  double noise(double sigma) { return sigma * normal_(random_); }

  rover::Vehicle vehicle_;
  rover::Pose2 pose_;
  Twist twist_;
  Twist twist_before_;
  double dt_s_ = 0.0;
  std::array<double, 6> angle_rad_{};
  std::array<double, 6> rate_radps_{};
  std::array<double, 4> steer_rad_{};
  std::array<double, 4> steer_rate_radps_{};
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

}  // namespace example
