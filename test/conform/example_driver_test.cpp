#include <gtest/gtest.h>

#include <cmath>

#include "broken_driver.hpp"
#include "driver/plane_camera.hpp"
#include "driver/plane_rover.hpp"
#include "driver/wheel_watchdog.hpp"

namespace example {
namespace {

using rover::kTickUs;
using rover::wheel_command_t;

wheel_command_t command(Utime utime, double rate_radps, double steer_rad = 0.0) {
  wheel_command_t out{};
  out.header.utime = out.header.release_utime = utime;
  out.header.seq = 1;
  out.header.boot_id = 1;
  out.valid_until_utime = utime + 200'000;
  std::fill_n(out.drive_rate_radps, 6, rate_radps);
  out.steer_angle_rad[0] = out.steer_angle_rad[1] = steer_rad;
  out.steer_angle_rad[2] = out.steer_angle_rad[3] = -steer_rad;
  return out;
}

double rate_in_force(WheelWatchdog& watchdog, Utime t) {
  const auto in_force = watchdog.in_force(t);
  return in_force ? in_force->drive_rate_radps[0] : 0.0;
}

TEST(WheelWatchdog, CommandIsValidFromReleaseToValidUntil) {
  WheelWatchdog watchdog;
  watchdog.take(command(1'000'000, 0.5));
  EXPECT_EQ(rate_in_force(watchdog, 980'000), 0.0);
  EXPECT_EQ(rate_in_force(watchdog, 1'000'000), 0.5);
  EXPECT_EQ(rate_in_force(watchdog, 1'200'000), 0.5);
  EXPECT_FALSE(watchdog.expired(1'200'000));
  EXPECT_EQ(rate_in_force(watchdog, 1'220'000), 0.0);
  EXPECT_TRUE(watchdog.expired(1'220'000));
}

TEST(WheelWatchdog, ReorderedOlderCommandIsIgnored) {
  WheelWatchdog watchdog;
  watchdog.take(command(1'100'000, 0.1));
  EXPECT_EQ(rate_in_force(watchdog, 1'100'000), 0.1);
  watchdog.take(command(1'000'000, 0.9));  // arrives out of order
  EXPECT_EQ(rate_in_force(watchdog, 1'120'000), 0.1);
}

TEST(WheelWatchdog, RestartedStackIsObeyedDespiteSequenceRestart) {
  WheelWatchdog watchdog;
  wheel_command_t last = command(1'000'000, 0.1);
  last.header.seq = 5000;
  last.header.boot_id = 3;
  watchdog.take(last);
  EXPECT_EQ(rate_in_force(watchdog, 1'000'000), 0.1);
  watchdog.take(command(9'000'000, 0.2));
  EXPECT_EQ(rate_in_force(watchdog, 9'000'000), 0.2);
}

TEST(WheelWatchdog, NaNOrUnlimitedValidityDoesNotMoveWheels) {
  WheelWatchdog watchdog;
  wheel_command_t broken = command(1'000'000, 0.5);
  broken.steer_angle_rad[3] = rover::kNaN;
  watchdog.take(broken);
  EXPECT_FALSE(watchdog.in_force(1'000'000).has_value());
  wheel_command_t endless = command(1'020'000, 0.5);
  endless.valid_until_utime += 3'600'000'000;
  watchdog.take(endless);
  EXPECT_FALSE(watchdog.in_force(1'020'000).has_value());
}

TEST(PlaneRover, DrivesTheCircleOfItsSteering) {
  const rover::Vehicle vehicle = rover::conform::small_vehicle();
  PlaneRover rover(vehicle, {});
  // The four corner wheels' circles share one centre: 3 m to the left on the middle wheels' axis.
  wheel_command_t turn{};
  const double radius_m = 3.0;
  for (size_t k = 0; k < 4; ++k) {
    const auto wheel = static_cast<size_t>(rover::kSteeredWheels[k]);
    turn.steer_angle_rad[k] = std::atan(vehicle.wheel_x_m[wheel] / (radius_m - vehicle.wheel_y_m[wheel]));
  }
  for (size_t i = 0; i < 6; ++i)
    turn.drive_rate_radps[i] = 0.4 * std::hypot(vehicle.wheel_x_m[i], radius_m - vehicle.wheel_y_m[i]) / radius_m;
  wheel_command_t stationary = turn;
  std::fill_n(stationary.drive_rate_radps, 6, 0.0);
  for (int i = 0; i < 300; ++i) rover.step(stationary, 0.02);
  EXPECT_NEAR(rover.pose().x_m, 0.0, 1e-9);
  for (int i = 0; i < 1500; ++i) rover.step(turn, 0.02);
  const rover::Pose2 end = rover.pose();
  EXPECT_NEAR(end.yaw_rad, 0.05 / radius_m * 29.9, 0.01);
  EXPECT_NEAR(end.x_m, radius_m * std::sin(end.yaw_rad), 0.01);
  EXPECT_NEAR(end.y_m, radius_m * (1.0 - std::cos(end.yaw_rad)), 0.01);
}

TEST(PlaneRover, ImuMeasuresGravityAndTurnRate) {
  PlaneRover rover(rover::conform::small_vehicle(), {});
  for (int i = 0; i < 150; ++i) rover.step(command(0, 0.0, 0.2), 0.02);
  double turned = 0.0;
  double up = 0.0;
  for (int i = 0; i < 100; ++i) {
    rover.step(command(0, 0.4, 0.2), 0.02);
    const rover::imu_t imu = rover.imu();
    turned += imu.fog_delta_yaw_rad;
    up += imu.delta_velocity_mps[2];
  }
  EXPECT_NEAR(turned, rover.pose().yaw_rad, 1e-4);
  EXPECT_GT(turned, 0.01);
  EXPECT_NEAR(up / 2.0, 9.81, 0.01);
}

// The texture is fixed to the ground: the image shifts as the rover moves.
TEST(PlaneCamera, TextureIsFixedToTheGround) {
  const rover::StereoRig rig = rover::conform::small_rig();
  const PlaneCamera camera(rig, 0.62);
  const auto difference = [](const rover::GrayImage& a, const rover::GrayImage& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.data.size(); ++i) sum += std::abs(a.data[i] - b.data[i]);
    return sum / static_cast<double>(a.data.size());
  };
  const rover::GrayImage here = camera.expose({}, 1).left;
  EXPECT_LT(difference(here, camera.expose({}, 2).left), 2.5);               // only noise
  EXPECT_GT(difference(here, camera.expose({0.3, 0.0, 0.0}, 1).left), 8.0);  // different ground
}

}  // namespace
}  // namespace example
