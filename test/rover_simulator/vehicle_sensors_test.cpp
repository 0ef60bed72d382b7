#include <gtest/gtest.h>

#include "rover_simulator/vehicle/sensors.hpp"

namespace rover {
namespace {

VehicleTruth resting() {
  VehicleTruth truth;
  truth.interval_s = 0.02;
  truth.delta_velocity_mps = {0.0, 0.0, 3.71 * 0.02};
  return truth;
}

SensorConfig perfect() {
  SensorConfig config;
  config = {.gyro_random_walk_rad_rts = 0,
            .gyro_bias_radps = 0,
            .gyro_bias_instability_radps = 0,
            .accel_random_walk_mps_rts = 0,
            .accel_bias_mps2 = 0,
            .accel_bias_instability_mps2 = 0,
            .fog_random_walk_rad_rts = 0,
            .fog_bias_radps = 0,
            .fog_bias_instability_radps = 0,
            .imu_misalignment_rad = 0,
            .encoder_step_rad = 0,
            .encoder_rate_noise_radps = 0,
            .steer_step_rad = 0,
            .steer_offset_rad = 0,
            .bogie_noise_rad = 0,
            .current_noise_a = 0};
  return config;
}

TEST(Sensors, EqualTruthWithoutErrors) {
  SensorSuite sensors(perfect(), 3);
  VehicleTruth truth = resting();
  truth.delta_angle_rad = {0.001, -0.002, 0.003};
  truth.wheel_angle_rad = {1, 2, 3, 4, 5, 6.123456};
  truth.drive_current_a = {1, 2, 3, 4, 5, 6};
  truth.steer_angle_rad = {0.1, -0.2, 0.3, -0.4};
  truth.bogie_angle_rad = {0.01, 0.02, 0.03};
  const ImuSample imu = sensors.sample_imu(truth);
  EXPECT_EQ(imu.dt_s, 0.02);
  EXPECT_EQ(imu.delta_angle_rad, truth.delta_angle_rad);
  EXPECT_EQ(imu.delta_velocity_mps, truth.delta_velocity_mps);
  EXPECT_EQ(imu.fog_delta_yaw_rad, 0.003);
  const WheelSample wheels = sensors.sample_wheels(truth);
  EXPECT_EQ(wheels.drive_angle_rad, truth.wheel_angle_rad);
  EXPECT_EQ(wheels.drive_current_a, truth.drive_current_a);
  EXPECT_EQ(wheels.steer_angle_rad, truth.steer_angle_rad);
  EXPECT_EQ(wheels.bogie_angle_rad, truth.bogie_angle_rad);
}

// Angle error of many gyros after one minute at rest: random walk grows with sqrt(t), bias with t.
TEST(Sensors, GyroErrorGrowthMatchesDataSheet) {
  SensorConfig walk = perfect(), bias = perfect();
  walk.gyro_random_walk_rad_rts = 4.4e-5;
  bias.gyro_bias_radps = 2.4e-5;
  const auto rms_after = [](const SensorConfig& config, int ticks) {
    double squares = 0.0;
    constexpr int kUnits = 150;
    for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
      SensorSuite sensors(config, seed);
      Eigen::Vector3d angle = Eigen::Vector3d::Zero();
      for (int i = 0; i < ticks; ++i) angle += sensors.sample_imu(resting()).delta_angle_rad;
      squares += angle.squaredNorm() / 3.0 / kUnits;
    }
    return std::sqrt(squares);
  };
  EXPECT_NEAR(rms_after(walk, 3000), 4.4e-5 * std::sqrt(60.0), 0.15 * 4.4e-5 * std::sqrt(60.0));
  EXPECT_NEAR(rms_after(bias, 3000), 2.4e-5 * 60.0, 0.15 * 2.4e-5 * 60.0);
  EXPECT_NEAR(rms_after(walk, 750), 0.5 * rms_after(walk, 3000), 0.1 * rms_after(walk, 3000));
}

TEST(Sensors, EncodersAreQuantised) {
  SensorConfig config = perfect();
  config.encoder_step_rad = 0.01;
  SensorSuite sensors(config, 1);
  VehicleTruth truth = resting();
  truth.wheel_angle_rad[0] = 123.4567;
  EXPECT_NEAR(sensors.sample_wheels(truth).drive_angle_rad[0], 123.46, 1e-9);
}

TEST(Sensors, RandomnessDependsOnlyOnSeed) {
  const auto sum = [](std::uint64_t seed) {
    SensorSuite sensors({}, seed);
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    double current = 0.0;
    for (int i = 0; i < 100; ++i) {
      total += sensors.sample_imu(resting()).delta_velocity_mps;
      current += sensors.sample_wheels(resting()).drive_current_a[3];
    }
    return total.sum() + current;
  };
  EXPECT_EQ(sum(5), sum(5));
  EXPECT_NE(sum(5), sum(6));
}

}  // namespace
}  // namespace rover
