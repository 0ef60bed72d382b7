#include <gtest/gtest.h>

#include <cmath>

#include "common/bus/vehicle_config.hpp"
#include "common/core/wheel_kinematics.hpp"
#include "test/trajectory_control/kinematic_rover.hpp"

namespace rover::locomotion {
namespace {

const Vehicle kVehicle = load_vehicle(ROVER_SOURCE_DIR "/config");

TEST(ArcSetpoints, ForwardKinematicsReturnsTheArcWithoutScrub) {
  for (double k = -1.0; k <= 1.0; k += 0.05)
    for (const double speed : {-0.2, 0.05, 0.2}) {
      const test::Twist twist = test::forward_kinematics(kVehicle, arc_setpoints(kVehicle, speed, k));
      EXPECT_NEAR(twist.forward_mps, speed, 1e-12) << k;
      EXPECT_NEAR(twist.left_mps, 0.0, 1e-12) << k;
      EXPECT_NEAR(twist.turn_radps, speed * k, 1e-12) << k;
      EXPECT_LT(twist.scrub_mps, 1e-12) << k;
    }
}

TEST(ArcSetpoints, EveryWheelAxisPassesThroughTheCentreOfRotation) {
  const double radius = 1.25;
  const WheelSetpoints wheels = arc_setpoints(kVehicle, 0.2, 1.0 / radius);
  for (size_t k = 0; k < 4; ++k) {
    const double x = kVehicle.wheel_x_m[kSteeredWheels[k]];
    const double y = kVehicle.wheel_y_m[kSteeredWheels[k]];
    const double a = wheels.steer_angle_rad[k];
    EXPECT_NEAR((0.0 - x) * std::cos(a) + (radius - y) * std::sin(a), 0.0, 1e-12) << k;
  }
}

TEST(ArcSetpoints, LeftAndRightTurnsAreMirrored) {
  const WheelSetpoints left = arc_setpoints(kVehicle, 0.2, 0.7);
  const WheelSetpoints right = arc_setpoints(kVehicle, 0.2, -0.7);
  for (size_t pair = 0; pair < 3; ++pair)
    EXPECT_NEAR(left.drive_rate_radps[2 * pair], right.drive_rate_radps[2 * pair + 1], 1e-12);
  EXPECT_NEAR(left.steer_angle_rad[0], -right.steer_angle_rad[1], 1e-12);
  EXPECT_GT(left.steer_angle_rad[0], 0.0);
  EXPECT_LT(left.steer_angle_rad[2], 0.0);
}

TEST(PointTurnSetpoints, ForwardKinematicsReturnsTheTurnWithoutScrub) {
  for (const double rate : {-0.2, 0.0, 0.1}) {
    const test::Twist twist = test::forward_kinematics(kVehicle, point_turn_setpoints(kVehicle, rate));
    EXPECT_NEAR(twist.forward_mps, 0.0, 1e-12);
    EXPECT_NEAR(twist.left_mps, 0.0, 1e-12);
    EXPECT_NEAR(twist.turn_radps, rate, 1e-12);
    EXPECT_LT(twist.scrub_mps, 1e-12);
  }
}

TEST(Steering, AnglesStayWithinTheVehicleLimits) {
  for (double k = -1.0; k <= 1.0; k += 0.05)
    for (const double angle : arc_setpoints(kVehicle, 0.2, k).steer_angle_rad)
      EXPECT_LE(std::abs(angle), kVehicle.steer_max_rad);
  for (const double angle : point_turn_setpoints(kVehicle, 0.1).steer_angle_rad)
    EXPECT_LE(std::abs(angle), kVehicle.steer_max_rad);
}

TEST(MaxSteeringGradient, IsTheLargestDifferenceQuotientOfTheSteeringAngles) {
  for (const double limit : {0.2, 0.5, 1.0}) {
    double largest = 0.0;
    constexpr double h = 1e-4;
    for (double k = -limit; k + h <= limit; k += h) {
      const auto a = arc_setpoints(kVehicle, 0.0, k).steer_angle_rad;
      const auto b = arc_setpoints(kVehicle, 0.0, k + h).steer_angle_rad;
      for (size_t i = 0; i < 4; ++i) largest = std::max(largest, std::abs(b[i] - a[i]) / h);
    }
    EXPECT_NEAR(max_steering_gradient(kVehicle, limit), largest, 1e-3) << limit;
  }
}

TEST(PointTurnRadius, IsTheDistanceOfTheCornerWheels) {
  EXPECT_NEAR(point_turn_radius_m(kVehicle), std::hypot(0.75, 0.41), 1e-12);
}

}  // namespace
}  // namespace rover::locomotion
