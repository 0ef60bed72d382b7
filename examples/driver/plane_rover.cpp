#include "driver/plane_rover.hpp"

#include <algorithm>
#include <cmath>

namespace example {
namespace {

constexpr double kGravityMps2 = 9.81;
constexpr double kDriveLagS = 0.10;
constexpr double kSteeringLagS = 0.15;
constexpr double kMaxRateRadps = 3.0;  // of the drive motors
constexpr double kRollingA = 1.2;
constexpr double kSteeringA = 0.2;
constexpr double kGyroNoiseRad = 6.0e-6;  // of one sample
constexpr double kFogNoiseRad = 1.0e-6;
constexpr double kForceNoiseMps = 2.0e-4;

}  // namespace

void PlaneRover::step(const std::optional<rover::wheel_command_t>& command, double dt_s) {
  dt_s_ = dt_s;
  for (size_t i = 0; i < 6; ++i) {
    const double wanted = command ? std::clamp(command->drive_rate_radps[i], -kMaxRateRadps, kMaxRateRadps) : 0.0;
    rate_radps_[i] += (wanted - rate_radps_[i]) * dt_s / kDriveLagS;
    if (wanted == 0.0 && std::abs(rate_radps_[i]) < 1e-3) rate_radps_[i] = 0.0;
    angle_rad_[i] += rate_radps_[i] * dt_s;
  }
  for (size_t k = 0; k < 4; ++k) {
    const double wanted = command ? command->steer_angle_rad[k] : steer_rad_[k];
    const double most = vehicle_.steer_rate_radps * dt_s;
    const double turned = std::clamp((wanted - steer_rad_[k]) * dt_s / kSteeringLagS, -most, most);
    steer_rad_[k] = std::clamp(steer_rad_[k] + turned, -vehicle_.steer_max_rad, vehicle_.steer_max_rad);
    steer_rate_radps_[k] = turned / dt_s;
  }
  twist_before_ = twist_;
  twist_ = rolling();
  const double c = std::cos(pose_.yaw_rad);
  const double s = std::sin(pose_.yaw_rad);
  pose_.x_m += (c * twist_.forward_mps - s * twist_.left_mps) * dt_s;
  pose_.y_m += (s * twist_.forward_mps + c * twist_.left_mps) * dt_s;
  pose_.yaw_rad += twist_.turn_radps * dt_s;
}

// Each wheel rolls along its steering and not across it; the body's motion is the least-squares solution of all twelve.
PlaneRover::Twist PlaneRover::rolling() const {
  Eigen::Matrix<double, 12, 3> A = Eigen::Matrix<double, 12, 3>::Zero();
  Eigen::Matrix<double, 12, 1> b;
  std::array<double, 6> steer{};
  for (size_t k = 0; k < 4; ++k) steer[rover::kSteeredWheels[k]] = steer_rad_[k];
  for (int i = 0; i < 6; ++i) {
    const double speed_mps = rate_radps_[i] * vehicle_.wheel_radius_m;
    A.row(2 * i) << 1.0, 0.0, -vehicle_.wheel_y_m[i];
    A.row(2 * i + 1) << 0.0, 1.0, vehicle_.wheel_x_m[i];
    b(2 * i) = speed_mps * std::cos(steer[i]);
    b(2 * i + 1) = speed_mps * std::sin(steer[i]);
  }
  const Eigen::Vector3d solution = A.colPivHouseholderQr().solve(b);
  return {solution(0), solution(1), solution(2)};
}

// An accelerometer feels the ground's push, not gravity: +g upward at rest.
rover::imu_t PlaneRover::imu() {
  rover::imu_t out{};
  out.dt_s = dt_s_;
  const double turned = twist_.turn_radps * dt_s_;
  const std::array<double, 3> angle = {0.0, 0.0, turned};
  const std::array<double, 3> velocity = {
      twist_.forward_mps - twist_before_.forward_mps - turned * twist_.left_mps,
      twist_.left_mps - twist_before_.left_mps + turned * twist_.forward_mps,
      kGravityMps2 * dt_s_,
  };
  for (size_t i = 0; i < 3; ++i) {
    out.delta_angle_rad[i] = angle[i] + noise(kGyroNoiseRad);
    out.delta_velocity_mps[i] = velocity[i] + noise(kForceNoiseMps);
  }
  out.fog_delta_yaw_rad = turned + noise(kFogNoiseRad);
  out.status = rover::imu_t::OK;
  return out;
}

rover::wheel_state_t PlaneRover::wheels(bool command_expired) const {
  rover::wheel_state_t out{};
  for (size_t i = 0; i < 6; ++i) {
    out.drive_angle_rad[i] = angle_rad_[i];
    out.drive_rate_radps[i] = rate_radps_[i];
    out.drive_current_a[i] = std::abs(rate_radps_[i]) > 0.01 ? kRollingA : 0.0;
  }
  for (size_t k = 0; k < 4; ++k) {
    out.steer_angle_rad[k] = steer_rad_[k];
    out.steer_current_a[k] = std::abs(steer_rate_radps_[k]) > 0.01 ? kSteeringA : 0.0;
  }
  out.status = command_expired ? rover::wheel_state_t::COMMAND_EXPIRED : rover::wheel_state_t::OK;
  return out;
}

}  // namespace example
