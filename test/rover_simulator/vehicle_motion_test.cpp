#include <gtest/gtest.h>

#include "rover_simulator/world/world.hpp"
#include "vehicle_fixture.hpp"
#include "world_fixture.hpp"

namespace rover {
namespace {

TEST(VehicleAtRest, RestsAtNominalHeightAndCarriesWeight) {
  const PlaneSurface level(Soil::kBedrock, 0.0);
  const VehicleSim sim(test_vehicle(), {}, level, {3.0, 4.0, 1.0});
  const VehicleTruth& truth = sim.truth();
  EXPECT_NEAR(truth.T_map_body.translation().x(), 3.0, 1e-3);
  EXPECT_NEAR(truth.T_map_body.translation().y(), 4.0, 1e-3);
  EXPECT_NEAR(truth.T_map_body.translation().z(), 0.62, 0.004);
  EXPECT_NEAR(yaw_of(truth.T_map_body), 1.0, 1e-3);
  EXPECT_LT(truth.velocity_map_mps.norm(), 1e-5);
  double load = 0.0;
  for (double n : truth.wheel_load_n) {
    load += n;
    EXPECT_NEAR(n, 61.8, 5.0);
  }
  EXPECT_NEAR(load, (82.0 + 6 * 2.0 + 3 * 2.0) * 3.71, 0.5);
  EXPECT_NEAR(truth.clearance_m, 0.30, 0.004);
  EXPECT_EQ(truth.collision, Collision::kNone);
  EXPECT_NEAR(truth.specific_force_body_mps2.z(), 3.71, 1e-3);
}

TEST(VehicleAtRest, UsesConfiguredGravity) {
  const PlaneSurface level(Soil::kFirm, 0.0);
  VehicleSimConfig config;
  config.gravity_mps2 = 9.81;
  const VehicleSim sim(test_vehicle(), config, level, {});
  EXPECT_NEAR(sim.truth().specific_force_body_mps2.z(), 9.81, 1e-3);
}

TEST(VehicleAtRest, IsParallelToSlope) {
  const PlaneSurface plane(Soil::kFirm, to_rad(12));
  const VehicleSim facing_up(test_vehicle(), {}, plane, {0, 0, 0}), across(test_vehicle(), {}, plane, {0, 0, kPi / 2});
  EXPECT_NEAR(rpy_of(facing_up.truth().T_map_body.linear()).y(), -to_rad(12), 0.005);
  EXPECT_NEAR(std::abs(rpy_of(across.truth().T_map_body.linear()).x()), to_rad(12), 0.01);
  EXPECT_NEAR(facing_up.truth().T_map_body.translation().x(), 0.0, 0.01);
}

// The start pose has a sigma of 0.2 deg; settling must not add to it.
TEST(VehicleAtRest, SettlesAtStartPoseOnRoughGround) {
  WorldConfig config;
  config.rocks.k = 0.0;
  config.roughness.rms_m = 0.06;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const World world(config, level_raster(40.0), seed);
    const Pose2 start{20.0, 18.0, 0.7 * static_cast<double>(seed)};
    const VehicleSim sim(test_vehicle(), {}, world, start);
    const Pose2 at = planar(sim.truth().T_map_body);
    EXPECT_LT(std::hypot(at.x_m - start.x_m, at.y_m - start.y_m), 0.005) << seed;
    EXPECT_LT(std::abs(wrap_angle(at.yaw_rad - start.yaw_rad)), to_rad(0.03)) << seed;
  }
}

// Also where the wheels slide sideways while the rover settles.
TEST(VehicleAtRest, SettlesAtStartPoseAcrossASlope) {
  WorldConfig config;
  config.rocks.k = 0.0;
  config.roughness.rms_m = 0.06;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const World world(config, plane_raster(40.0, 40.0, 1.0, to_rad(15.0), kPi / 2), seed);
    const VehicleSim sim(test_vehicle(), {}, world, {20.0, 18.0, 0.0});
    const Pose2 at = planar(sim.truth().T_map_body);
    EXPECT_LT(std::hypot(at.x_m - 20.0, at.y_m - 18.0), 0.005) << seed;
    EXPECT_LT(std::abs(at.yaw_rad), to_rad(0.03)) << seed;
  }
}

TEST(VehicleDrive, DrivesStraightAtWheelSpeed) {
  const PlaneSurface level(Soil::kBedrock, 0.0);
  VehicleSim sim(test_vehicle(), {}, level, {});
  drive(sim, straight(0.2), 3.0);
  const Eigen::Vector3d before = sim.truth().T_map_body.translation();
  drive(sim, straight(0.2), 5.0);
  const Eigen::Vector3d way = sim.truth().T_map_body.translation() - before;
  EXPECT_NEAR(way.x(), 1.0, 0.01);
  EXPECT_NEAR(way.y(), 0.0, 0.002);
  drive(sim, straight(-0.2), 8.0);
  EXPECT_LT(sim.truth().velocity_map_mps.x(), -0.19);
}

// All wheels tangent to a circle of radius 2 m to the left.
TEST(VehicleDrive, DrivesCircleGivenBySteering) {
  const Vehicle vehicle = test_vehicle();
  const PlaneSurface level(Soil::kFirm, 0.0);
  VehicleSim sim(vehicle, {}, level, {});
  WheelCommand command;
  for (int i = 0; i < 4; ++i) {
    const int wheel = kSteeredWheels[i];
    command.steer_angle_rad[i] = std::atan(vehicle.wheel_x_m[wheel] / (2.0 - vehicle.wheel_y_m[wheel]));
  }
  drive(sim, command, 5.0);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(sim.truth().steer_angle_rad[i], command.steer_angle_rad[i], 0.03);
  for (int wheel = 0; wheel < 6; ++wheel)
    command.drive_rate_radps[wheel] =
        0.1 / 2.0 * std::hypot(vehicle.wheel_x_m[wheel], 2.0 - vehicle.wheel_y_m[wheel]) / vehicle.wheel_radius_m;
  drive(sim, command, 3.0);
  const double yaw = yaw_of(sim.truth().T_map_body);
  drive(sim, command, 10.0);
  EXPECT_NEAR(wrap_angle(yaw_of(sim.truth().T_map_body) - yaw), 0.05 * 10.0, 0.02);
  EXPECT_NEAR(sim.truth().rate_body_radps.z(), 0.05, 0.003);
}

TEST(VehicleDrive, SteeringRateIsLimited) {
  const PlaneSurface level(Soil::kFirm, 0.0);
  VehicleSim sim(test_vehicle(), {}, level, {});
  WheelCommand command;
  command.steer_angle_rad.fill(1.0);
  drive(sim, command, 2.0);
  EXPECT_NEAR(sim.truth().steer_angle_rad[0], 2.0 * to_rad(11.5), 0.03);
  for (double current : sim.truth().steer_current_a) {
    EXPECT_GT(current, 0.15);
    EXPECT_LT(current, 1.0);
  }
  command.steer_angle_rad.fill(3.0);
  drive(sim, command, 12.0);
  EXPECT_NEAR(sim.truth().steer_angle_rad[0], to_rad(90.7), 0.03);
}

TEST(VehicleTruth, IncrementsIntegrateToTrueMotion) {
  WorldConfig config;
  config.rocks.k = 0.02;
  const World world(config, plane_raster(40, 40, 1.0, 0.05, 0.4), 3);
  const Vehicle vehicle = test_vehicle();
  VehicleSim sim(vehicle, {}, world, {10, 20, 0.2});
  const Eigen::Vector3d lever = vehicle.imu_position_m;
  Eigen::Matrix3d R = sim.truth().T_map_body.linear();
  Eigen::Vector3d v = sim.truth().velocity_map_mps + R * sim.truth().rate_body_radps.cross(lever);
  for (int tick = 0; tick < 500; ++tick) {
    sim.advance(0.02, straight(0.2));
    const VehicleTruth& truth = sim.truth();
    const Eigen::Matrix3d R_mid = R * exp_so3(0.5 * truth.delta_angle_rad);
    v += R_mid * truth.delta_velocity_mps - Eigen::Vector3d(0, 0, 3.71 * truth.interval_s);
    R = R * exp_so3(truth.delta_angle_rad);
  }
  const VehicleTruth& truth = sim.truth();
  EXPECT_LT(log_so3(R.transpose() * truth.T_map_body.linear()).norm(), 1e-6);
  const Eigen::Vector3d v_true =
      truth.velocity_map_mps + truth.T_map_body.linear() * truth.rate_body_radps.cross(lever);
  EXPECT_LT((v - v_true).norm(), 0.01);
  EXPECT_GT(truth.T_map_body.translation().x(), 11.5);
}

TEST(VehicleTruth, IsDeterministic) {
  WorldConfig config;
  config.rocks.k = 0.05;
  const World world(config, plane_raster(40, 40, 1.0, 0.05, 0.4), 3);
  VehicleSim a(test_vehicle(), {}, world, {10, 20, 0}), b(test_vehicle(), {}, world, {10, 20, 0});
  drive(a, straight(0.15), 20.0);
  drive(b, straight(0.15), 20.0);
  EXPECT_EQ(a.truth().T_map_body.matrix(), b.truth().T_map_body.matrix());
  EXPECT_EQ(a.truth().wheel_angle_rad, b.truth().wheel_angle_rad);
  EXPECT_EQ(a.truth().drive_current_a, b.truth().drive_current_a);
}

}  // namespace
}  // namespace rover
