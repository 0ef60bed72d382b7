#include "trajectory_control/teleop.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "trajectory_control/config.hpp"

namespace rover::control {
namespace {

class TeleopTest : public testing::Test {
 protected:
  MotionCommand drive(double speed_mps, double curvature_per_m) {
    return teleop_command(now_, {now_ - kTickUs, speed_mps, curvature_per_m}, permit_, config_);
  }

  TrajectoryControlConfig config_ = load_config(ROVER_SOURCE_DIR "/config");
  Utime now_ = 1'000'000;
  DrivePermit permit_{now_ - kTickUs, now_ + 150'000, true, 0.1};
};

TEST_F(TeleopTest, DrivesArcsWithinThePermittedSpeed) {
  const MotionCommand command = drive(0.5, 0.3);
  EXPECT_EQ(command.mode, MotionMode::kArc);
  EXPECT_EQ(command.speed_mps, 0.1);
  EXPECT_EQ(command.curvature_per_m, 0.3);
  EXPECT_EQ(command.valid_until, now_ + 200'000);
  EXPECT_EQ(drive(-0.5, 0.0).speed_mps, -0.1);
}

TEST_F(TeleopTest, TurnsOnTheSpotBelowTheMinimumRadius) {
  const MotionCommand command = drive(0.1, -50.0);
  EXPECT_EQ(command.mode, MotionMode::kPointTurn);
  EXPECT_EQ(command.turn_rate_radps, -config_.max_turn_rate_radps);
  EXPECT_EQ(command.speed_mps, 0.0);
}

TEST_F(TeleopTest, StopsWithoutFreshCommandOrPermitAndOnNan) {
  EXPECT_EQ(drive(kNaN, 0.0).valid_until, now_);
  EXPECT_EQ(drive(0.1, kNaN).valid_until, now_);
  EXPECT_EQ(drive(0.0, 0.0).mode, MotionMode::kStop);
  EXPECT_EQ(teleop_command(now_, {now_ - 600'000, 0.1, 0.0}, permit_, config_).valid_until, now_);
  EXPECT_EQ(teleop_command(now_, {kNever, 0.1, 0.0}, permit_, config_).valid_until, now_);
  permit_.granted = false;
  EXPECT_EQ(drive(0.1, 0.0).valid_until, now_);
}

}  // namespace
}  // namespace rover::control
