// Models of the vehicle's proprioceptive sensors: noise, bias, quantisation. Seeded; one sample per tick.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <random>

#include "rover_simulator/vehicle/vehicle_sim.hpp"

namespace rover {

// Defaults: Sensonor STIM300 data sheet (angle random walk 0.15 deg/sqrt(h), gyro bias instability 0.3 deg/h, velocity
// random walk 0.07 m/s/sqrt(h), accelerometer bias instability 0.05 mg); KVH DSP-1760 data sheet for the fibre-optic
// gyro (0.012 deg/sqrt(h), 0.05 deg/h). Constant biases are residuals after ground calibration [est].
struct SensorConfig {
  double gyro_random_walk_rad_rts = 4.4e-5;     // rad/sqrt(s) = 0.15 deg/sqrt(h)
  double gyro_bias_radps = 2.4e-5;              // rms at start, each axis: 5 deg/h
  double gyro_bias_instability_radps = 1.5e-6;  // 0.3 deg/h, first-order Markov
  double accel_random_walk_mps_rts = 1.2e-3;    // m/s/sqrt(s) = 0.07 m/s/sqrt(h)
  double accel_bias_mps2 = 7.4e-3;              // rms at start: 0.75 mg
  double accel_bias_instability_mps2 = 4.9e-4;  // 0.05 mg
  double fog_random_walk_rad_rts = 3.5e-6;      // 0.012 deg/sqrt(h)
  double fog_bias_radps = 4.8e-6;               // 1 deg/h
  double fog_bias_instability_radps = 2.4e-7;   // 0.05 deg/h
  double bias_correlation_s = 600.0;
  double imu_misalignment_rad = 5e-4;  // rms, each axis, of the mounting
  double encoder_step_rad = 1.745e-3;  // wheel side: 0.1 deg
  double encoder_rate_noise_radps = 0.003;
  double steer_step_rad = 1.745e-3;
  double steer_offset_rad = 2e-3;  // rms of each wheel's zero
  double bogie_noise_rad = 1e-3;
  double current_noise_a = 0.03;
};

// As in imu_t: increments over the interval that ends now.
struct ImuSample {
  double dt_s = 0.0;
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();
  double fog_delta_yaw_rad = 0.0;
};

// As in wheel_state_t.
struct WheelSample {
  std::array<double, 6> drive_angle_rad{};
  std::array<double, 6> drive_rate_radps{};
  std::array<double, 6> drive_current_a{};
  std::array<double, 4> steer_angle_rad{};
  std::array<double, 4> steer_current_a{};
  std::array<double, 3> bogie_angle_rad{};
};

class SensorSuite {
 public:
  SensorSuite(const SensorConfig& config, std::uint64_t seed);
  // Call each once per advance() of the vehicle, in this order.
  ImuSample sample_imu(const VehicleTruth& truth);
  WheelSample sample_wheels(const VehicleTruth& truth);

 private:
  // Constant and first-order Gauss-Markov part of one axis.
  struct Bias {
    double constant = 0.0;
    double wander = 0.0;
    double sigma = 0.0;
    double value() const { return constant + wander; }
  };

  double normal(double sigma) { return sigma * normal_(random_); }
  Bias make_bias(double constant_sigma, double instability);
  void wander(Bias& bias, double dt_s);

  SensorConfig config_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::array<Bias, 3> gyro_bias_;
  std::array<Bias, 3> accel_bias_;
  Bias fog_bias_;
  Eigen::Matrix3d R_imu_body_;
  std::array<double, 4> steer_offset_rad_{};
};

}  // namespace rover
