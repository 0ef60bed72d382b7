#include "rover_simulator/vehicle/sensors.hpp"

#include <cmath>

namespace rover {
namespace {

double quantised(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

}  // namespace

SensorSuite::SensorSuite(const SensorConfig& config, std::uint64_t seed) : config_(config), random_(seed) {
  for (Bias& bias : gyro_bias_) bias = make_bias(config.gyro_bias_radps, config.gyro_bias_instability_radps);
  for (Bias& bias : accel_bias_) bias = make_bias(config.accel_bias_mps2, config.accel_bias_instability_mps2);
  fog_bias_ = make_bias(config.fog_bias_radps, config.fog_bias_instability_radps);
  Eigen::Vector3d tilt;
  for (double& axis : tilt) axis = normal(config.imu_misalignment_rad);
  R_imu_body_ = exp_so3(tilt);
  for (double& offset : steer_offset_rad_) offset = normal(config.steer_offset_rad);
}

SensorSuite::Bias SensorSuite::make_bias(double constant_sigma, double instability) {
  Bias bias;
  bias.constant = normal(constant_sigma);
  bias.wander = normal(instability);
  bias.sigma = instability;
  return bias;
}

void SensorSuite::wander(Bias& bias, double dt_s) {
  const double keep = std::exp(-dt_s / config_.bias_correlation_s);
  bias.wander = keep * bias.wander + normal(bias.sigma * std::sqrt(1.0 - keep * keep));
}

ImuSample SensorSuite::sample_imu(const VehicleTruth& truth) {
  ImuSample sample;
  const double dt = truth.interval_s, root_dt = std::sqrt(dt);
  sample.dt_s = dt;
  sample.delta_angle_rad = R_imu_body_ * truth.delta_angle_rad;
  sample.delta_velocity_mps = R_imu_body_ * truth.delta_velocity_mps;
  for (int axis = 0; axis < 3; ++axis) {
    wander(gyro_bias_[axis], dt);
    wander(accel_bias_[axis], dt);
    sample.delta_angle_rad[axis] += gyro_bias_[axis].value() * dt + normal(config_.gyro_random_walk_rad_rts * root_dt);
    sample.delta_velocity_mps[axis] +=
        accel_bias_[axis].value() * dt + normal(config_.accel_random_walk_mps_rts * root_dt);
  }
  wander(fog_bias_, dt);
  sample.fog_delta_yaw_rad =
      truth.delta_angle_rad.z() + fog_bias_.value() * dt + normal(config_.fog_random_walk_rad_rts * root_dt);
  return sample;
}

WheelSample SensorSuite::sample_wheels(const VehicleTruth& truth) {
  WheelSample sample;
  for (int i = 0; i < 6; ++i) {
    sample.drive_angle_rad[i] = quantised(truth.wheel_angle_rad[i], config_.encoder_step_rad);
    sample.drive_rate_radps[i] = truth.wheel_rate_radps[i] + normal(config_.encoder_rate_noise_radps);
    sample.drive_current_a[i] = truth.drive_current_a[i] + normal(config_.current_noise_a);
  }
  for (int i = 0; i < 4; ++i) {
    sample.steer_angle_rad[i] = quantised(truth.steer_angle_rad[i] + steer_offset_rad_[i], config_.steer_step_rad);
    sample.steer_current_a[i] = truth.steer_current_a[i] + normal(config_.current_noise_a);
  }
  for (int i = 0; i < 3; ++i) sample.bogie_angle_rad[i] = truth.bogie_angle_rad[i] + normal(config_.bogie_noise_rad);
  return sample;
}

}  // namespace rover
