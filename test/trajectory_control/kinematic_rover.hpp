// Kinematic rover for closed-loop tests: rate-limited first-order steering, first-order drive motors, body motion as
// the least-squares fit of the wheel motion, and optional slip.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/frames.hpp"
#include "common/core/vehicle.hpp"
#include "common/core/wheel_kinematics.hpp"

namespace rover::test {

struct Twist {
  double forward_mps = 0.0;
  double left_mps = 0.0;
  double turn_radps = 0.0;
  double scrub_mps = 0.0;  // largest difference between wheel rolling and ground motion
};

// Forward kinematics by least squares over the six wheels.
inline Twist forward_kinematics(const Vehicle& v, const WheelSetpoints& wheels) {
  Eigen::Matrix<double, 12, 3> A = Eigen::Matrix<double, 12, 3>::Zero();
  Eigen::Matrix<double, 12, 1> b;
  std::array<double, 6> angle{};
  for (size_t k = 0; k < 4; ++k) angle[kSteeredWheels[k]] = wheels.steer_angle_rad[k];
  for (int i = 0; i < 6; ++i) {
    const double rolling = wheels.drive_rate_radps[i] * v.wheel_radius_m;
    A.row(2 * i) << 1.0, 0.0, -v.wheel_y_m[i];
    A.row(2 * i + 1) << 0.0, 1.0, v.wheel_x_m[i];
    b(2 * i) = rolling * std::cos(angle[i]);
    b(2 * i + 1) = rolling * std::sin(angle[i]);
  }
  const Eigen::Vector3d x = A.colPivHouseholderQr().solve(b);
  const Eigen::Matrix<double, 12, 1> residual = A * x - b;
  Twist out{x(0), x(1), x(2), 0.0};
  for (int i = 0; i < 6; ++i) out.scrub_mps = std::max(out.scrub_mps, residual.segment<2>(2 * i).norm());
  return out;
}

class KinematicRover {
 public:
  explicit KinematicRover(const Vehicle& vehicle) : vehicle_(vehicle) {}

  void step(const WheelSetpoints& command, double dt_s) {
    constexpr double kSteeringLagS = 0.15;
    constexpr double kDriveLagS = 0.10;
    const double max_step_rad = vehicle_.steer_rate_radps * dt_s;
    for (size_t k = 0; k < 4; ++k) {
      double& angle = wheels_.steer_angle_rad[k];
      angle += std::clamp((command.steer_angle_rad[k] - angle) * dt_s / kSteeringLagS, -max_step_rad, max_step_rad);
    }
    for (size_t i = 0; i < 6; ++i) {
      double& rate = wheels_.drive_rate_radps[i];
      rate += (command.drive_rate_radps[i] - rate) * dt_s / kDriveLagS;
    }
    twist_ = forward_kinematics(vehicle_, wheels_);
    twist_.forward_mps *= 1.0 - slip_ratio;
    twist_.turn_radps *= 1.0 - turn_slip;
    twist_.left_mps += side_slip * twist_.forward_mps;
    pose_.yaw_rad += twist_.turn_radps * dt_s;
    const double c = std::cos(pose_.yaw_rad);
    const double s = std::sin(pose_.yaw_rad);
    pose_.x_m += (c * twist_.forward_mps - s * twist_.left_mps) * dt_s;
    pose_.y_m += (s * twist_.forward_mps + c * twist_.left_mps) * dt_s;
  }

  void put(const Pose2& pose) { pose_ = pose; }
  const Pose2& pose() const { return pose_; }
  const Twist& twist() const { return twist_; }
  const WheelSetpoints& wheels() const { return wheels_; }
  double fastest_wheel_mps() const {
    double fastest = 0.0;
    for (const double rate : wheels_.drive_rate_radps) fastest = std::max(fastest, std::abs(rate));
    return fastest * vehicle_.wheel_radius_m;
  }

  double slip_ratio = 0.0;  // lost fraction of the forward motion
  double turn_slip = 0.0;   // lost fraction of the turn rate
  double side_slip = 0.0;   // leftward speed per forward speed

 private:
  Vehicle vehicle_;
  Pose2 pose_;
  Twist twist_;
  WheelSetpoints wheels_;
};

}  // namespace rover::test
