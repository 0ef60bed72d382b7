#include "locomotion/locomotion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "locomotion/config.hpp"
#include "test/trajectory_control/kinematic_rover.hpp"

namespace rover::locomotion {
namespace {

// Locomotion with a kinematic rover; permit and command are refreshed each tick unless disabled.
class LocomotionTest : public testing::Test {
 protected:
  void tick() {
    now_ += kTickUs;
    if (permit_alive_) permit_ = {now_ - kTickUs, now_ + to_utime(0.18), true, max_speed_};
    if (command_alive_) {
      command_.utime = now_ - kTickUs;
      command_.valid_until = now_ + to_utime(0.18);
    }
    if (wheels_alive_) wheels_ = {now_, rover_.wheels().steer_angle_rad, wheel_fault_, command_expired_};
    if (blocked_at_rad_) wheels_.steer_angle_rad[3] = std::max(wheels_.steer_angle_rad[3], *blocked_at_rad_);
    out_ = locomotion_.step(now_, command_, permit_, wheels_);
    if (out_.valid) applied_ = out_.wheels;
    rover_.step(applied_, to_seconds(kTickUs));
    largest_scrub_ = std::max(largest_scrub_, rover_.twist().scrub_mps);
  }
  void run(double seconds) {
    for (Utime end = now_ + to_utime(seconds); now_ < end;) tick();
  }
  // Seconds until the commanded wheel speed is zero.
  double time_to_stop() {
    const Utime start = now_;
    while (commanded_speed() != 0.0 && now_ - start < to_utime(10.0)) tick();
    return to_seconds(now_ - start);
  }
  double commanded_speed() const {
    double fastest = 0.0;
    for (const double rate : out_.wheels.drive_rate_radps) fastest = std::max(fastest, std::abs(rate));
    return fastest * config_.vehicle.wheel_radius_m;
  }
  void arc(double speed, double curvature) { command_ = {now_, now_, MotionMode::kArc, speed, curvature, 0.0}; }
  void point_turn(double rate) { command_ = {now_, now_, MotionMode::kPointTurn, 0.0, 0.0, rate}; }

  NodeConfig config_ = load_config(ROVER_SOURCE_DIR "/config");
  Locomotion locomotion_{config_.locomotion, config_.vehicle};
  test::KinematicRover rover_{config_.vehicle};
  MotionCommand command_;
  DrivePermit permit_;
  WheelReading wheels_;
  WheelCommand out_;
  WheelSetpoints applied_;
  Utime now_ = 0;
  bool permit_alive_ = true;
  bool command_alive_ = true;
  bool wheels_alive_ = true;
  bool wheel_fault_ = false;
  bool command_expired_ = false;
  std::optional<double> blocked_at_rad_;  // a rock limits the right rear wheel to this angle
  double max_speed_ = 0.2;
  double largest_scrub_ = 0.0;
};

TEST_F(LocomotionTest, RampsUpAndDownAtTheVehicleAcceleration) {
  arc(0.2, 0.0);
  double before = 0.0;
  while (now_ < to_utime(3.0)) {
    tick();
    EXPECT_LE(commanded_speed() - before, 0.118 * 0.02 + 1e-12);
    before = commanded_speed();
  }
  EXPECT_NEAR(before, 0.2, 1e-12);
  command_.mode = MotionMode::kStop;
  EXPECT_NEAR(time_to_stop(), 0.2 / 0.118, 0.03);
}

TEST_F(LocomotionTest, NoWheelTurnsWithoutPermit) {
  permit_alive_ = false;
  arc(0.2, 0.5);
  run(2.0);
  EXPECT_EQ(commanded_speed(), 0.0);
  EXPECT_EQ(out_.wheels.steer_angle_rad, (std::array<double, 4>{}));
}

TEST_F(LocomotionTest, NoWheelTurnsWithoutCommand) {
  arc(0.2, 0.5);
  command_alive_ = false;
  run(2.0);
  EXPECT_EQ(commanded_speed(), 0.0);
}

TEST_F(LocomotionTest, LostPermitStopsWithinItsValidityPlusEmergencyRamp) {
  arc(0.2, 0.0);
  run(3.0);
  permit_alive_ = false;
  const double x = rover_.pose().x_m;
  EXPECT_LE(time_to_stop(), 0.2 + 0.5 + 0.03);
  run(1.0);
  EXPECT_LT(rover_.pose().x_m - x, 0.2 * 0.2 + 0.05 + 0.03);
}

TEST_F(LocomotionTest, WithdrawnPermitStopsAtOnce) {
  arc(0.2, 0.0);
  run(3.0);
  permit_alive_ = false;
  permit_ = {now_, now_, false, 0.0};
  EXPECT_LE(time_to_stop(), 0.5 + 0.03);
}

TEST_F(LocomotionTest, LostCommandStopsTheWheels) {
  arc(0.2, 0.0);
  run(3.0);
  command_alive_ = false;
  EXPECT_LE(time_to_stop(), 0.2 + 0.5 + 0.03);
}

TEST_F(LocomotionTest, NanInCommandStopsTheWheels) {
  arc(0.2, 0.0);
  run(3.0);
  command_.curvature_per_m = kNaN;
  EXPECT_LE(time_to_stop(), 0.5 + 0.03);
  for (const double angle : out_.wheels.steer_angle_rad) EXPECT_TRUE(std::isfinite(angle));
}

TEST_F(LocomotionTest, NoWheelStateMeansNoValidCommand) {
  wheels_alive_ = false;
  arc(0.2, 0.0);
  run(1.0);
  EXPECT_FALSE(out_.valid);
  EXPECT_EQ(commanded_speed(), 0.0);
}

TEST_F(LocomotionTest, StaleWheelStateStopsTheRover) {
  arc(0.2, 0.0);
  run(3.0);
  wheels_alive_ = false;
  run(1.0);
  EXPECT_FALSE(out_.valid);
  EXPECT_EQ(commanded_speed(), 0.0);
}

TEST_F(LocomotionTest, WheelFaultStopsTheRover) {
  arc(0.2, 0.0);
  run(3.0);
  wheel_fault_ = true;
  EXPECT_LE(time_to_stop(), 0.5 + 0.03);
}

TEST_F(LocomotionTest, RampRestartsFromZeroAfterTheDriverStopped) {
  arc(0.2, 0.0);
  run(3.0);
  command_expired_ = true;
  tick();
  command_expired_ = false;
  EXPECT_LT(commanded_speed(), 0.01);
  run(3.0);
  EXPECT_NEAR(commanded_speed(), 0.2, 1e-12);
}

TEST_F(LocomotionTest, SpeedIsLimitedByThePermit) {
  max_speed_ = 0.05;
  arc(0.2, 0.0);
  run(3.0);
  EXPECT_NEAR(commanded_speed(), 0.05, 1e-12);
}

TEST_F(LocomotionTest, WheelsOfAPointTurnAreLimitedByThePermit) {
  const double radius_m = point_turn_radius_m(config_.vehicle);
  for (const double turn_rate : {to_rad(13.0), -to_rad(13.0)}) {
    point_turn(turn_rate);
    max_speed_ = 0.05;
    run(15.0);
    EXPECT_NEAR(commanded_speed(), 0.05, 1e-12);
    EXPECT_EQ(rover_.twist().turn_radps > 0.0, turn_rate > 0.0);
    max_speed_ = 0.2;
    run(3.0);
    const auto unlimited = point_turn_setpoints(config_.vehicle, turn_rate * radius_m / radius_m);
    EXPECT_EQ(out_.wheels.drive_rate_radps, unlimited.drive_rate_radps);
  }
}

TEST_F(LocomotionTest, CurvatureIsLimitedByTheMinimumRadius) {
  arc(0.1, 5.0);
  run(15.0);
  EXPECT_NEAR(rover_.twist().turn_radps / rover_.twist().forward_mps, 1.0, 1e-3);
}

TEST_F(LocomotionTest, WheelsShareOneCentreOfRotationWhileSteering) {
  arc(0.2, 0.8);
  run(8.0);
  arc(0.2, -0.8);
  run(10.0);
  EXPECT_NEAR(rover_.twist().turn_radps / rover_.twist().forward_mps, -0.8, 1e-3);
  EXPECT_LT(largest_scrub_, 0.005);
}

TEST_F(LocomotionTest, SteeringSetpointsRespectTheMotorRate) {
  arc(0.2, 1.0);
  auto before = rover_.wheels().steer_angle_rad;
  for (int i = 0; i < 600; ++i) {
    if (i == 300) point_turn(0.2);
    tick();
    for (size_t k = 0; k < 4; ++k)
      EXPECT_LE(std::abs(out_.wheels.steer_angle_rad[k] - before[k]), config_.vehicle.steer_rate_radps * 0.02 + 1e-12);
    before = out_.wheels.steer_angle_rad;
  }
}

TEST_F(LocomotionTest, StaysStationaryUntilAlignedForAPointTurn) {
  arc(0.2, 0.0);
  run(3.0);
  point_turn(0.2);
  double rolled_misaligned = 0.0;
  for (int i = 0; i < 1000; ++i) {
    tick();
    const auto desired = point_turn_setpoints(config_.vehicle, 0.0).steer_angle_rad;
    double error_rad = 0.0;
    for (size_t k = 0; k < 4; ++k)
      error_rad = std::max(error_rad, std::abs(rover_.wheels().steer_angle_rad[k] - desired[k]));
    const bool straight = std::abs(rover_.wheels().steer_angle_rad[0]) < 0.02;
    if (error_rad > to_rad(6.0) && !straight) rolled_misaligned = std::max(rolled_misaligned, commanded_speed());
  }
  EXPECT_EQ(rolled_misaligned, 0.0);
  EXPECT_NEAR(rover_.twist().turn_radps, 0.2, 1e-3);
  EXPECT_NEAR(rover_.twist().forward_mps, 0.0, 1e-6);
  arc(0.2, 0.0);
  run(10.0);
  EXPECT_NEAR(rover_.twist().forward_mps, 0.2, 1e-3);
}

TEST_F(LocomotionTest, JammedSteeringMotorStopsTheRover) {
  arc(0.2, 0.0);
  run(3.0);
  arc(0.2, 0.8);
  for (int i = 0; i < 500; ++i) {
    tick();
    wheels_alive_ = false;  // replaced by the reading below: wheels that do not move
    wheels_ = {now_ + kTickUs, {}, false, false};
  }
  EXPECT_EQ(commanded_speed(), 0.0);
  EXPECT_GT(out_.steering_error_rad, config_.locomotion.steering_stop_rad);
}

TEST_F(LocomotionTest, SteeringHoldsItsAngleWhenTheLeaseIsLost) {
  arc(0.2, 0.6);
  run(8.0);
  const auto angles = out_.wheels.steer_angle_rad;
  permit_alive_ = false;
  command_.mode = MotionMode::kPointTurn;
  run(3.0);
  for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(out_.wheels.steer_angle_rad[k], angles[k], 1e-9);
}

TEST_F(LocomotionTest, WithoutALeaseTheServoDoesNotPushAgainstARock) {
  blocked_at_rad_ = -0.3;
  point_turn(0.2);
  run(7.0);
  EXPECT_LT(out_.wheels.steer_angle_rad[3], -1.0);
  permit_alive_ = false;
  run(1.0);
  EXPECT_EQ(out_.wheels.steer_angle_rad[3], -0.3);
  blocked_at_rad_ = -0.2;  // the wheel yields: the held angle does not follow at first
  run(0.9);
  EXPECT_EQ(out_.wheels.steer_angle_rad[3], -0.3);
  run(0.3);  // lasting deflection: the servo yields, otherwise it would overheat
  EXPECT_EQ(out_.wheels.steer_angle_rad[3], -0.2);
}

TEST_F(LocomotionTest, AlignmentResumesFromTheHeldAngles) {
  blocked_at_rad_ = -0.3;
  point_turn(0.2);
  run(7.0);
  permit_alive_ = false;
  run(1.0);
  permit_alive_ = true;
  for (double before = -0.3; before > -1.0; before = out_.wheels.steer_angle_rad[3]) {
    tick();
    EXPECT_LE(std::abs(out_.wheels.steer_angle_rad[3] - before), config_.vehicle.steer_rate_radps * 0.02 + 1e-12);
    EXPECT_EQ(commanded_speed(), 0.0);
    ASSERT_LT(now_, to_utime(30.0));
  }
}

TEST_F(LocomotionTest, LostLeaseInABendNeedsNoNewAlignment) {
  arc(0.2, 0.6);
  run(8.0);
  permit_alive_ = false;
  run(2.0);
  permit_alive_ = true;
  tick();
  EXPECT_EQ(out_.state, LocomotionState::kDriving);
}

TEST_F(LocomotionTest, StalledWheelIsRolledFree) {
  blocked_at_rad_ = -0.8;  // 15 deg short of the point-turn angle
  point_turn(0.2);
  run(5.5);
  EXPECT_EQ(commanded_speed(), 0.0);
  run(1.5);
  EXPECT_GT(commanded_speed(), 0.0);
  EXPECT_LE(commanded_speed(), config_.locomotion.stall.speed_mps + 1e-12);
  blocked_at_rad_.reset();
  run(3.0);
  EXPECT_NEAR(rover_.twist().turn_radps, 0.2, 1e-3);
}

TEST_F(LocomotionTest, StallRecoveryGivesUpAfterItsDistance) {
  blocked_at_rad_ = -0.8;
  point_turn(0.2);
  double rolled_m = 0.0;
  for (int i = 0; i < 1500; ++i) {
    tick();
    rolled_m += commanded_speed() * 0.02;
  }
  EXPECT_EQ(commanded_speed(), 0.0);
  EXPECT_NEAR(rolled_m, config_.locomotion.stall.max_distance_m, 0.02);
}

TEST_F(LocomotionTest, NoStallRecoveryWithALargeMeanSteeringError) {
  blocked_at_rad_ = 0.0;  // 61 deg short of the point-turn angle
  point_turn(0.2);
  run(20.0);
  EXPECT_EQ(commanded_speed(), 0.0);
}

TEST_F(LocomotionTest, StartsFromTheMeasuredSteeringAngles) {
  WheelSetpoints turned;
  turned.steer_angle_rad = {-1.0, 1.0, 1.0, -1.0};
  for (int i = 0; i < 1000; ++i) rover_.step(turned, 0.02);
  arc(0.2, 0.0);
  tick();
  EXPECT_NEAR(out_.wheels.steer_angle_rad[0], -1.0, 0.01);
  EXPECT_EQ(commanded_speed(), 0.0);
  run(10.0);
  EXPECT_NEAR(rover_.twist().forward_mps, 0.2, 1e-3);
}

}  // namespace
}  // namespace rover::locomotion
