#include "trajectory_control/trajectory_controller.hpp"

#include <gtest/gtest.h>

#include "test/trajectory_control/drive_loop.hpp"

namespace rover::control {
namespace {

constexpr Utime kNow = 5'000'000;

// One step with valid inputs, unless the test modifies one of them first.
class ControllerTest : public testing::Test {
 protected:
  ControllerTest() { controller_.set_path({7, 0.75, {{0.0, 0.0}, {20.0, 0.0}}}); }
  ControlOutput step() { return controller_.step(kNow, pose_, permit_); }
  void expect_no_command(ControlState state) {
    const ControlOutput out = step();
    EXPECT_EQ(out.state, state);
    EXPECT_EQ(out.command.mode, MotionMode::kStop);
    EXPECT_EQ(out.command.speed_mps, 0.0);
    EXPECT_FALSE(command_valid(out.command, kNow, 200'000));
  }

  // Prediction on the same path from the current position after 3 s at that velocity.
  double predicted_after_moving(double forward_mps, double left_mps) {
    TrajectoryController controller(load_config(test::config_dir()));
    controller.set_path({7, 0.75, {{0.0, 0.0}, {20.0, 0.0}}});
    pose_.forward_mps = forward_mps;
    pose_.left_mps = left_mps;
    ControlOutput out;
    for (Utime t = kNow; t < kNow + 3'000'000; t += kTickUs) {
      pose_.utime = t;
      permit_ = {t, t + 200'000, true, 0.2};
      out = controller.step(t, pose_, permit_);
    }
    return out.predicted_corridor_error_m;
  }

  TrajectoryController controller_{load_config(test::config_dir())};
  PoseInput pose_{kNow - 20'000, true, {3.0, 0.1, 0.05}, 0.2, 0.0};
  DrivePermit permit_{kNow - 20'000, kNow + 180'000, true, 0.2};
};

TEST_F(ControllerTest, FollowsWithFreshPoseAndPermit) {
  const ControlOutput out = step();
  EXPECT_EQ(out.state, ControlState::kFollowing);
  EXPECT_EQ(out.command.mode, MotionMode::kArc);
  EXPECT_LT(out.command.curvature_per_m, 0.0);
  EXPECT_GT(out.command.speed_mps, 0.1);
  EXPECT_EQ(out.command.valid_until, kNow + 200'000);
  EXPECT_EQ(out.path_id, 7);
  EXPECT_NEAR(out.arc_length_m, 3.0, 1e-6);
  EXPECT_NEAR(out.remaining_m, 17.0, 1e-6);
  EXPECT_NEAR(out.cross_track_m, 0.1, 1e-6);
  EXPECT_NEAR(out.heading_error_rad, 0.05, 1e-6);
  EXPECT_GE(out.predicted_corridor_error_m, 0.1 - 1e-6);
  EXPECT_EQ(out.corridor_half_width_m, 0.75);
}

TEST_F(ControllerTest, StalePoseGivesNoCommand) {
  pose_.utime = kNow - 200'000;
  EXPECT_EQ(step().state, ControlState::kFollowing);
  pose_.utime = kNow - 200'001;
  expect_no_command(ControlState::kStalePose);
}

TEST_F(ControllerTest, MissingPoseGivesNoCommand) {
  pose_ = {};
  expect_no_command(ControlState::kStalePose);
}

TEST_F(ControllerTest, PoseFromTheFutureGivesNoCommand) {
  pose_.utime = kNow + 1;
  expect_no_command(ControlState::kStalePose);
}

TEST_F(ControllerTest, LostPoseGivesNoCommand) {
  pose_.usable = false;
  expect_no_command(ControlState::kStalePose);
}

TEST_F(ControllerTest, NanInPoseGivesNoCommand) {
  const PoseInput good = pose_;
  for (double* field : {&pose_.odom.x_m, &pose_.odom.y_m, &pose_.odom.yaw_rad, &pose_.forward_mps, &pose_.left_mps}) {
    pose_ = good;
    *field = kNaN;
    expect_no_command(ControlState::kStalePose);
  }
}

TEST_F(ControllerTest, NoPermitGivesNoCommand) {
  permit_.granted = false;
  expect_no_command(ControlState::kNoPermit);
  permit_ = {};
  expect_no_command(ControlState::kNoPermit);
}

TEST_F(ControllerTest, StalePermitGivesNoCommand) {
  permit_.valid_until = kNow + 10'000'000;
  permit_.utime = kNow - 200'001;
  expect_no_command(ControlState::kNoPermit);
}

TEST_F(ControllerTest, OutOfCorridorGivesNoCommandWithOrWithoutPermit) {
  pose_.odom.y_m = -0.76;
  expect_no_command(ControlState::kOutOfCorridor);
  permit_.granted = false;  // the supervisor must still see the state
  expect_no_command(ControlState::kOutOfCorridor);
}

TEST_F(ControllerTest, IdleWithoutPath) {
  TrajectoryController empty(load_config(test::config_dir()));
  const ControlOutput out = empty.step(kNow, pose_, permit_);
  EXPECT_EQ(out.state, ControlState::kIdle);
  EXPECT_EQ(out.path_id, -1);
  EXPECT_EQ(out.command.mode, MotionMode::kStop);
}

TEST_F(ControllerTest, InvalidPathRemovesTheOldOne) {
  EXPECT_FALSE(controller_.set_path({8, 0.75, {{0.0, 0.0}}}));
  const ControlOutput out = step();
  EXPECT_EQ(out.state, ControlState::kIdle);
  EXPECT_EQ(out.command.mode, MotionMode::kStop);
}

TEST_F(ControllerTest, SpeedIsLimitedByThePermit) {
  permit_.max_speed_mps = 0.07;
  EXPECT_DOUBLE_EQ(step().command.speed_mps, 0.07);
}

TEST_F(ControllerTest, FullSpeedOnThePath) {
  pose_.odom = {3.0, 0.0, 0.0};
  EXPECT_NEAR(step().command.speed_mps, 0.2, 1e-9);
}

TEST_F(ControllerTest, SlowsDownWhileTheWheelsSteer) {
  pose_.odom = {3.0, 0.0, to_rad(-30.0)};
  const ControlOutput out = step();
  EXPECT_EQ(out.state, ControlState::kFollowing);
  EXPECT_GT(out.command.curvature_per_m, 0.5);
  EXPECT_LT(out.command.speed_mps, 0.1);
  EXPECT_GT(out.command.speed_mps, 0.0);
}

TEST_F(ControllerTest, CompensatesTheResponseDelayBeforeABend) {
  const TrajectoryControlConfig config = load_config(test::config_dir());
  const auto points = test::polyline({{0.0, 5.0}, {0.5, 5.0}});
  const auto curvature_at_speed = [&](double speed) {
    TrajectoryController controller(config);
    controller.set_path({1, 0.75, points});
    pose_.odom = {4.9, 0.0, 0.0};
    pose_.forward_mps = speed;
    return controller.step(kNow, pose_, permit_).command.curvature_per_m;
  };
  EXPECT_GT(curvature_at_speed(0.2), curvature_at_speed(0.0) + 0.01);
}

TEST_F(ControllerTest, LargeHeadingErrorTurnsOnTheSpot) {
  for (const double sign : {-1.0, 1.0}) {
    pose_.odom.yaw_rad = sign * to_rad(41.0);
    const ControlOutput out = step();
    EXPECT_EQ(out.state, ControlState::kPointTurn);
    EXPECT_EQ(out.command.mode, MotionMode::kPointTurn);
    EXPECT_LT(out.command.turn_rate_radps * sign, 0.0);
    EXPECT_EQ(out.command.speed_mps, 0.0);
  }
}

// From a heading error of 35 deg the minimum radius leads 0.25 m aside: out of a corridor of 0.2 m half width.
TEST_F(ControllerTest, SlowRoverThatWouldLeaveItsCorridorTurnsOnTheSpot) {
  controller_.set_path({8, 0.2, {{0.0, 0.0}, {20.0, 0.0}}});
  for (const double forward_mps : {0.0, 0.08}) {
    pose_ = {kNow - 20'000, true, {3.0, 0.0, 0.61}, forward_mps, 0.0};
    EXPECT_EQ(step().state, ControlState::kPointTurn) << forward_mps;
  }
}

TEST_F(ControllerTest, AtSpeedOrInAWideCorridorTheSameErrorIsDrivenWithAnArc) {
  pose_ = {kNow - 20'000, true, {3.0, 0.0, 0.61}, 0.0, 0.0};
  EXPECT_EQ(step().state, ControlState::kFollowing);
  controller_.set_path({8, 0.2, {{0.0, 0.0}, {20.0, 0.0}}});
  pose_.forward_mps = 0.2;
  EXPECT_EQ(step().state, ControlState::kFollowing);
}

TEST_F(ControllerTest, PointTurnContinuesUntilTheStopAngle) {
  pose_.odom.yaw_rad = to_rad(41.0);
  step();
  pose_.odom.yaw_rad = to_rad(20.0);
  EXPECT_EQ(step().state, ControlState::kPointTurn);
  pose_.odom.yaw_rad = to_rad(1.5);
  EXPECT_EQ(step().state, ControlState::kFollowing);
  pose_.odom.yaw_rad = to_rad(20.0);
  EXPECT_EQ(step().state, ControlState::kFollowing);
}

TEST_F(ControllerTest, PredictedCorridorErrorIncludesSideSlip) {
  pose_.odom = {3.0, 0.0, 0.0};
  const double level = step().predicted_corridor_error_m;
  EXPECT_LT(level, 0.01);
  EXPECT_GT(predicted_after_moving(0.2, 0.06), 0.05);
}

// Reverse motion on a forward path must not be measured as a side slip of 180 deg.
TEST_F(ControllerTest, TeleoperatedReverseIsNotTakenForSideSlip) {
  pose_.odom = {3.0, 0.0, 0.0};
  EXPECT_LT(predicted_after_moving(-0.2, 0.01), 0.01);
}

TEST_F(ControllerTest, PathEndIsReportedWithAndWithoutPermit) {
  pose_.odom = {19.99, 0.0, 0.0};
  EXPECT_EQ(step().state, ControlState::kPathEnd);
  permit_.granted = false;
  EXPECT_EQ(step().state, ControlState::kPathEnd);
  pose_.odom = {20.3, 0.0, 0.0};
  EXPECT_EQ(step().state, ControlState::kPathEnd);
  EXPECT_EQ(step().command.mode, MotionMode::kStop);
}

}  // namespace
}  // namespace rover::control
