// Behaviour of localization on synthetic drives with late, missing, frozen and wrong inputs.
#include "localization/localization.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synthetic_drive.hpp"

namespace rover::loc {
namespace {

using Eigen::Vector3d;

Twist arc(double t) {
  return t < 1.5 ? Twist{} : Twist{0.2, 0.08 * std::sin(0.15 * t)};
}
Twist point_turn(double t) {
  return t < 1.5 ? Twist{} : Twist{0.0, 0.2};
}

double position_error(const SyntheticDrive& drive) {
  return (drive.localization.pose().T_odom_body.translation() - drive.truth_odom().translation()).norm();
}

double attitude_error(const SyntheticDrive& drive) {
  return log_so3(drive.localization.pose().T_odom_body.linear().transpose() * drive.truth_odom().linear()).norm();
}

TEST(Localization, UninitialisedUntilStaticAlignmentAndStartPose) {
  SyntheticDrive drive({}, 1);
  drive.run(0.5);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kUninitialised);
  EXPECT_FALSE(is_finite(drive.localization.pose().T_odom_body));
  EXPECT_NE(drive.localization.set_start_pose({Vector3d::Zero(), 0.0, 0.1, 0.1}), "");
  drive.run(1.5);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kUninitialised);
  EXPECT_TRUE(is_finite(drive.localization.pose().T_odom_body));
  EXPECT_EQ(drive.localization.set_start_pose({Vector3d(5.0, 6.0, 7.0), 1.0, 0.1, 0.1}), "");
  drive.run(0.1);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kOk);
  const Eigen::Isometry3d T_map_body = drive.localization.pose().T_map_odom * drive.localization.pose().T_odom_body;
  EXPECT_LT((T_map_body.translation() - Vector3d(5.0, 6.0, 7.0)).norm(), 1e-3);
  EXPECT_NEAR(yaw_of(T_map_body), 1.0, 1e-3);
}

TEST(Localization, NoStaticAlignmentWhileMoving) {
  SyntheticDrive drive({}, 1);
  drive.command = [](double) { return Twist{0.1, 0.0}; };
  drive.run(5.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kUninitialised);
  EXPECT_FALSE(is_finite(drive.localization.pose().T_odom_body));
}

// A car at 12 m/s from the first image on, without IMU and wheels.
TEST(Localization, CameraOnlyModeTracksCarAt12MetresPerSecond) {
  LocalizationConfig config;
  config.camera_only = {true, 0.02, -0.03};
  config.filter.no_gyro_noise_rad_rts = 10.0;
  config.status.max_dead_reckoned_m = 50.0;
  SyntheticDrive drive(config, 2);
  drive.imu_on = drive.wheels_on = drive.rolling_ground = false;
  drive.command = [](double t) { return Twist{12.0, 0.1 * std::sin(0.5 * t)}; };
  drive.run(0.2);
  EXPECT_EQ(drive.localization.set_start_pose({Vector3d(3.0, 4.0, 0.0), 0.0, 0.1, 0.01}), "");
  drive.run(10.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kOk);
  const Vector3d rpy = rpy_of(drive.localization.pose().T_odom_body.linear());
  EXPECT_NEAR(rpy.x(), 0.02, 0.01) << "configured attitude";
  EXPECT_NEAR(rpy.y(), -0.03, 0.01);
  EXPECT_NEAR(drive.localization.pose().travelled_m, drive.driven_m(), 8.0) << "an image every 0.4 s";
  drive.visual_on = false;
  drive.run(3.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kLost);
}

TEST(Localization, RejectsVisualMotionAboveMaxSpeed) {
  LocalizationConfig config;
  config.max_speed_mps = 0.1;
  SyntheticDrive drive(config, 2);
  drive.align_and_start();
  drive.command = [](double) { return Twist{0.2, 0.0}; };
  drive.run(6.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kDegraded) << "all visual motions are rejected";
}

TEST(Localization, StaticAlignmentFindsRollAndPitch) {
  SyntheticDrive drive({}, 3);
  drive.run(2.0);
  EXPECT_LT(attitude_error(drive), 0.003);
}

TEST(Localization, DriftBelowHalfPercentOverRollingGround) {
  SyntheticDrive drive({}, 1);
  drive.command = arc;
  drive.align_and_start();
  drive.run(300.0);
  EXPECT_GT(drive.driven_m(), 55.0);
  EXPECT_LT(position_error(drive), 0.005 * drive.driven_m());
  EXPECT_LT(attitude_error(drive), 0.01);
  EXPECT_NEAR(drive.localization.pose().travelled_m, drive.driven_m(), 0.01 * drive.driven_m());
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kOk);
}

// Sample times are compared with the tick: compared with the pose, they would stay in the future after the step.
TEST(Localization, RecoversFromClockStep) {
  SyntheticDrive drive({}, 1);
  drive.command = arc;
  drive.align_and_start();
  drive.run(10.0);
  drive.step_clock(2.0);
  drive.run(3.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kOk) << drive.localization.pose().reason;
  EXPECT_LT(position_error(drive), 0.1);
}

TEST(Localization, VisualOdometryCorrectsWheelSlip) {
  SyntheticDrive drive({}, 1);
  drive.command = arc;
  drive.slip = [](double) { return 0.4; };
  drive.align_and_start();
  drive.run(120.0);
  EXPECT_LT(position_error(drive), 0.01 * drive.driven_m());
}

// Rocks tilt the body by degrees within a second; its origin moves by centimetres that no wheel rolls.
TEST(Localization, PoseAndSlipFollowARockingBodyBetweenVisualMotions) {
  SyntheticDrive drive({}, 3);
  drive.rolling_ground = false;
  drive.command = [](double t) { return t < 1.5 ? Twist{} : Twist{0.2, 0.0}; };
  drive.rock = [](double t) {
    const double since = std::max(0.0, t - 1.5);
    return Eigen::Vector2d(0.06 * std::sin(1.3 * since), 0.06 * std::sin(1.7 * since));
  };
  drive.align_and_start();
  double worst_m = 0.0, worst_slip = 0.0;
  drive.run(30.0, [&] {
    const PoseEstimate& pose = drive.localization.pose();
    worst_m = std::max(worst_m, (pose.T_odom_body.translation() - drive.truth_odom().translation()).norm());
    if (const Slip slip = drive.localization.slip(); slip.valid)
      worst_slip = std::max(worst_slip, std::abs(slip.slip_ratio));
  });
  EXPECT_LT(worst_m, 0.02) << "0.08 m, and a slip of 0.27, if wheels are taken to move the origin";
  EXPECT_LT(worst_slip, 0.01);
}

TEST(Localization, NoDriftAtStandstill) {
  SyntheticDrive drive({}, 2);
  drive.command = [](double t) { return t < 1.5 || t > 11.5 ? Twist{} : Twist{0.2, 0.05}; };
  drive.align_and_start();
  drive.run(12.0);
  const Eigen::Isometry3d stopped = drive.localization.pose().T_odom_body;
  const double travelled = drive.localization.pose().travelled_m;
  drive.run(600.0);
  const Eigen::Isometry3d later = drive.localization.pose().T_odom_body;
  // Within the noise of one keyframe alignment, independent of the time.
  EXPECT_LT((later.translation() - stopped.translation()).norm(), 0.004);
  EXPECT_LT(std::abs(wrap_angle(yaw_of(later) - yaw_of(stopped))), 0.0005);
  EXPECT_NEAR(drive.localization.pose().travelled_m, travelled, 0.01);
}

// After each stop the body rocks, below the rate threshold of standstill detection.
TEST(Localization, GyroBiasUpdateStartsOnlyWhenBodyHasSettled) {
  SyntheticDrive drive({}, 2);
  drive.command = [](double t) { return t < 1.5 || t > 11.5 ? Twist{} : Twist{0.2, 0.0}; };
  drive.align_and_start();
  const auto fog_variance = [&] { return drive.localization.checkpoint()->P(kBias + 2, kBias + 2); };
  drive.run(10.0);
  const double driving = fog_variance();
  drive.run(4.5);
  EXPECT_GT(fog_variance(), 0.95 * driving);
  drive.run(10.0);
  EXPECT_LT(fog_variance(), 0.1 * driving);
}

// The body rotates some ticks before the wheels move measurably: a bias update from them erred by 2 deg/h.
TEST(Localization, OnsetOfMotionDoesNotBiasGyro) {
  SyntheticDrive drive({}, 2);
  const auto onset = [](double t) { return t > 30.0 && t < 30.2 ? 2e-3 : 0.0; };
  drive.corrupt_imu = [&](ImuSample& sample) {
    sample.fog_delta_yaw_rad += onset(to_seconds(sample.utime)) * sample.dt_s;
  };
  drive.align_and_start();
  const auto fog_bias_radps = [&] { return drive.localization.checkpoint()->gyro_bias_radps.z(); };
  drive.run(28.0);
  const double before = fog_bias_radps();
  drive.run(1.2);
  EXPECT_NEAR(fog_bias_radps(), before, 1e-6);
}

// Rotation below the rate threshold must not change the gyro bias, whose correlation with position would move the
// rover.
TEST(Localization, SteeringOnTheSpotIsNotStandstill) {
  SyntheticDrive drive({}, 7);
  drive.command = [](double t) { return t < 1.5 || t > 501.5 ? Twist{} : Twist{0.2, 0.02 * std::sin(0.05 * t)}; };
  drive.scrub = [](double t) { return t > 505.0 && t < 510.0 ? to_rad(0.12) : 0.0; };
  drive.align_and_start();
  drive.run(502.0);
  const Eigen::Isometry3d before = drive.localization.pose().T_odom_body;
  const double yaw_truth = yaw_of(drive.truth_odom());
  drive.run(100.0);
  const Eigen::Isometry3d after = drive.localization.pose().T_odom_body;
  const double turned = wrap_angle(yaw_of(drive.truth_odom()) - yaw_truth);
  EXPECT_NEAR(turned, to_rad(0.6), 0.001);
  EXPECT_NEAR(wrap_angle(yaw_of(after) - yaw_of(before)), turned, 0.002);
  EXPECT_LT((after.translation() - before.translation()).norm(), 0.01);
}

TEST(Localization, PointTurnKeepsPosition) {
  SyntheticDrive drive({}, 4);
  drive.rolling_ground = false;
  drive.command = point_turn;
  drive.align_and_start();
  drive.run(31.4);
  EXPECT_LT(position_error(drive), 0.01);
  EXPECT_LT(attitude_error(drive), 0.005);
  EXPECT_LT(drive.localization.pose().travelled_m, 0.1);
}

TEST(Localization, PublishedPoseNeverJumps) {
  SyntheticDrive drive({}, 5);
  drive.command = arc;
  drive.slip = [](double t) { return 0.2 + 0.2 * std::sin(0.5 * t); };
  drive.align_and_start();
  Vector3d last = drive.localization.pose().T_odom_body.translation();
  double largest = 0.0;
  drive.run(120.0, [&] {
    const Vector3d p = drive.localization.pose().T_odom_body.translation();
    largest = std::max(largest, (p - last).norm());
    last = p;
  });
  // 0.2 m/s are 4 mm per tick.
  EXPECT_LT(largest, 0.007);
}

TEST(Localization, WheelOdometryBridgesLostFrames) {
  SyntheticDrive drive({}, 6);
  drive.command = arc;
  drive.align_and_start();
  drive.run(20.0);
  for (int i = 0; i < 10; ++i) {
    drive.visual_lost = true;
    drive.run(1.6);
    drive.visual_lost = false;
    drive.run(2.4);
  }
  EXPECT_LT(position_error(drive), 0.01 * drive.driven_m());
}

TEST(Localization, WheelOdometryBridgesGapBetweenKeyframes) {
  SyntheticDrive drive({}, 6);
  drive.command = arc;
  drive.align_and_start();
  drive.run(20.0);
  // Visual odometry restarts after a gap: no motion spans 20.4 .. 22.4 s.
  drive.corrupt_visual = [&](VisualMotion& m) {
    if (m.previous_utime < 22'400'000 && m.utime > 20'400'000) m.status = VisualStatus::kLost;
  };
  drive.run(30.0);
  EXPECT_LT(position_error(drive), 0.015 * drive.driven_m());
}

TEST(Localization, MissingVisualOdometryDegradesThenLost) {
  SyntheticDrive drive({}, 7);
  drive.command = arc;
  drive.align_and_start();
  drive.run(10.0);
  const double sigma_before = std::sqrt(drive.localization.pose().cov(0, 0));
  drive.visual_on = false;
  drive.run(2.5);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kDegraded);
  EXPECT_GT(std::sqrt(drive.localization.pose().cov(0, 0)), sigma_before + 0.01);
  drive.run(12.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kLost);
  drive.visual_on = true;
  drive.run(1.5);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kOk);
  // The wheels did not slip, so the pose is still good.
  EXPECT_LT(position_error(drive), 0.2);
}

struct ImuFailure {
  const char* name;
  std::function<void(SyntheticDrive&)> inject;
};

TEST(Localization, ImuFailureDegradesWithoutBlocking) {
  const std::vector<ImuFailure> failures = {
      {"silent", [](SyntheticDrive& d) { d.imu_on = false; }},
      {"frozen",
       [](SyntheticDrive& d) {
         d.corrupt_imu = [](ImuSample& s) {
           s.delta_angle_rad = Vector3d(0.001, 0.0, 0.002);
           s.delta_velocity_mps = Vector3d(0.0, 0.0, 0.0742);
         };
       }},
      {"nan", [](SyntheticDrive& d) { d.corrupt_imu = [](ImuSample& s) { s.delta_angle_rad.x() = kNaN; }; }},
      {"fault", [](SyntheticDrive& d) { d.corrupt_imu = [](ImuSample& s) { s.healthy = false; }; }},
  };
  for (const ImuFailure& failure : failures) {
    SyntheticDrive drive({}, 8);
    drive.command = arc;
    drive.align_and_start();
    drive.run(20.0);
    failure.inject(drive);
    drive.run(5.0);
    const PoseEstimate& pose = drive.localization.pose();
    EXPECT_EQ(pose.status, PoseStatus::kDegraded) << failure.name;
    EXPECT_EQ(pose.utime, drive.now()) << failure.name;
    EXPECT_LT(position_error(drive), 0.1) << failure.name;
    EXPECT_LT(attitude_error(drive), 0.03) << failure.name;
    drive.run(6.0);
    EXPECT_EQ(pose.status, PoseStatus::kLost) << failure.name;
    drive.imu_on = true;
    drive.corrupt_imu = [](ImuSample&) {};
    drive.run(1.0);
    EXPECT_EQ(pose.status, PoseStatus::kOk) << failure.name;
  }
}

TEST(Localization, AnImuThatIsTicksLateIsUsed) {
  for (const size_t ticks : {1, 4}) {
    SyntheticDrive drive({}, 8);
    drive.command = arc;
    std::deque<ImuSample> late;
    drive.corrupt_imu = [&](ImuSample& s) {
      late.push_back(s);
      s = late.front();
      if (late.size() > ticks) late.pop_front();
    };
    drive.align_and_start();
    drive.run(20.0);
    const PoseEstimate& pose = drive.localization.pose();
    EXPECT_EQ(pose.status, PoseStatus::kOk) << ticks;
    EXPECT_GT(pose.rate_body_radps.head<2>().norm(), 0.0) << "roll and pitch rates come from the gyro";
    EXPECT_LT(attitude_error(drive), 0.03) << ticks;
    EXPECT_LT(position_error(drive), 0.1) << ticks;
  }
}

TEST(Localization, WrongGyroIsDetectedByVisualOdometry) {
  SyntheticDrive drive({}, 9);
  drive.command = arc;
  drive.align_and_start();
  drive.run(20.0);
  drive.corrupt_imu = [](ImuSample& s) { s.fog_delta_yaw_rad += 0.1 * s.dt_s; };
  drive.run(8.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kDegraded);
  drive.run(20.0);
  // Detection takes five conflicts of 0.4 s at 0.1 rad/s.
  EXPECT_LT(attitude_error(drive), 0.35);
  const double error_at_detection = attitude_error(drive);
  drive.run(20.0);
  EXPECT_NEAR(attitude_error(drive), error_at_detection, 0.05);
}

// One motion of 0.4 s agrees, two together do not.
TEST(Localization, AGyroThatIsALittleWrongIsDetectedOverLongerMotions) {
  for (const double rate_radps : {0.02, 0.01}) {
    SyntheticDrive drive({}, 9);
    drive.command = arc;
    drive.align_and_start();
    drive.run(20.0);
    drive.corrupt_imu = [&](ImuSample& s) { s.fog_delta_yaw_rad += rate_radps * s.dt_s; };
    drive.run(60.0);
    EXPECT_EQ(drive.localization.pose().status, PoseStatus::kDegraded) << rate_radps;
    EXPECT_LT(attitude_error(drive), 0.15) << rate_radps;
  }
}

// What it contradicted while at rest, over long motions, does not bind it for ever.
TEST(Localization, AGyroThatIsRightAgainIsUsedAgain) {
  SyntheticDrive drive({}, 9);
  drive.command = arc;
  drive.align_and_start();
  drive.run(20.0);
  drive.corrupt_imu = [](ImuSample& s) { s.fog_delta_yaw_rad += 0.05 * s.dt_s; };
  drive.run(20.0);
  drive.command = [](double) { return Twist{}; };
  drive.run(30.0);
  ASSERT_EQ(drive.localization.pose().status, PoseStatus::kDegraded);
  drive.corrupt_imu = [](ImuSample&) {};
  drive.command = arc;
  drive.run(20.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kOk);
}

TEST(Localization, SingleVisualOutlierIsRejected) {
  SyntheticDrive drive({}, 10);
  drive.command = arc;
  drive.align_and_start();
  drive.run(20.0);
  bool once = true;
  drive.corrupt_visual = [&](VisualMotion& m) {
    if (!once) return;
    once = false;
    m.T_prev_cur.linear() = m.T_prev_cur.linear() * exp_so3(Vector3d(0.0, 0.0, 0.2));
  };
  drive.run(5.0);
  EXPECT_EQ(drive.localization.gyro_conflicts(), 1);
  EXPECT_LT(position_error(drive), 0.05);
  EXPECT_LT(attitude_error(drive), 0.01);
}

TEST(Localization, VisualOdometryBridgesMissingWheels) {
  SyntheticDrive drive({}, 11);
  drive.command = arc;
  drive.align_and_start();
  drive.run(20.0);
  drive.wheels_on = false;
  drive.run(20.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kDegraded);
  EXPECT_LT(position_error(drive), 0.05);
  drive.visual_on = false;
  drive.run(2.0);
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kLost);
}

TEST(Localization, ShortEncoderGapIsCountedOnce) {
  for (const double gap_s : {0.14, 0.3, 0.46}) {
    SyntheticDrive drive({}, 11);
    drive.command = arc;
    drive.align_and_start();
    drive.run(20.0);
    drive.wheels_on = false;
    drive.run(gap_s);
    drive.wheels_on = true;
    drive.run(1.0, [&] { EXPECT_LT(drive.localization.pose().velocity_body_mps.norm(), 0.25); });
    EXPECT_LT(position_error(drive), 0.03);
  }
}

TEST(Localization, InvalidInputIsRejectedAndChangesNothing) {
  SyntheticDrive clean({}, 12);
  SyntheticDrive dirty({}, 12);
  for (SyntheticDrive* drive : {&clean, &dirty}) {
    drive->command = arc;
    drive->align_and_start();
    drive->run(5.0);
  }
  dirty.run(5.0, [&] {
    ImuSample imu;
    imu.utime = dirty.now() + 1;
    imu.dt_s = kNaN;
    EXPECT_NE(dirty.localization.add_imu(imu), "");
    imu.dt_s = 0.02;
    imu.utime = dirty.now();
    EXPECT_NE(dirty.localization.add_imu(imu), "");  // not newer
    imu.utime = dirty.now() + 3'600'000'000;
    EXPECT_NE(dirty.localization.add_imu(imu), "");  // from the future
    WheelSample wheels;
    wheels.utime = dirty.now() + 1;
    wheels.drive_angle_rad[3] = kInfinity;
    EXPECT_NE(dirty.localization.add_wheels(wheels), "");
    VisualMotion visual;
    visual.utime = dirty.now();
    visual.previous_utime = dirty.now() - 400'000;
    visual.keyframe_utime = visual.previous_utime;
    visual.status = VisualStatus::kOk;
    EXPECT_NE(dirty.localization.add_visual_motion(visual), "");  // NaN motion
    EXPECT_NE(dirty.localization.set_start_pose({Vector3d(kNaN, 0.0, 0.0), 0.0, 0.1, 0.1}), "");
  });
  clean.run(5.0);
  EXPECT_EQ(clean.localization.pose().T_odom_body.matrix(), dirty.localization.pose().T_odom_body.matrix());
}

TEST(Localization, VisualLatencyDoesNotChangeEstimate) {
  // Checked long after a stop, when all motions have arrived.
  SyntheticDrive drive({}, 13);
  drive.command = [](double t) { return t < 1.5 || t > 21.5 ? Twist{} : Twist{0.2, 0.1}; };
  drive.slip = [](double) { return 0.3; };
  drive.align_and_start();
  drive.run(24.0);
  EXPECT_LT(position_error(drive), 0.02);
}

TEST(Localization, SlipRatioInDriveAndStop) {
  SyntheticDrive drive({}, 14);
  drive.command = [](double t) {
    if (t < 1.5 || (t > 20.0 && t < 30.0)) return Twist{};
    return Twist{0.2, 0.05};
  };
  drive.slip = [](double) { return 0.3; };
  drive.align_and_start();
  drive.run(15.0);
  const Slip driving = drive.localization.slip();
  EXPECT_TRUE(driving.valid);
  EXPECT_NEAR(driving.slip_ratio, 0.3, 0.05);
  EXPECT_NEAR(driving.wheel_mps, 0.2, 0.01);
  EXPECT_NEAR(driving.visual_mps, 0.14, 0.01);
  EXPECT_NEAR(driving.commanded_mps, 0.2, 0.01);
  drive.run(11.0);  // stationary for 7.5 s: no motion in the window
  const Slip stationary = drive.localization.slip();
  EXPECT_FALSE(stationary.valid);
  EXPECT_TRUE(std::isnan(stationary.slip_ratio));
  EXPECT_NEAR(stationary.wheel_mps, 0.0, 1e-3);
  drive.run(5.0);
  EXPECT_TRUE(drive.localization.slip().valid);
  EXPECT_NEAR(drive.localization.slip().slip_ratio, 0.3, 0.05);
}

TEST(Localization, SlipIsValidInPointTurn) {
  SyntheticDrive drive({}, 15);
  drive.rolling_ground = false;
  drive.command = point_turn;
  drive.align_and_start();
  drive.run(10.0);
  EXPECT_TRUE(drive.localization.slip().valid);
  EXPECT_NEAR(drive.localization.slip().slip_ratio, 0.0, 0.05);
}

TEST(Localization, SlipIsInvalidWithoutVisualOdometry) {
  SyntheticDrive drive({}, 16);
  drive.command = arc;
  drive.align_and_start();
  drive.run(10.0);
  EXPECT_TRUE(drive.localization.slip().valid);
  drive.visual_on = false;
  drive.run(7.0);
  EXPECT_FALSE(drive.localization.slip().valid);
  EXPECT_TRUE(std::isnan(drive.localization.slip().slip_ratio));
}

// Measured 0.4 s before the pose, with a yaw sigma of 0.01 rad.
MapMeasurement offset_measurement(const PoseEstimate& pose, double x_m, double yaw_rad, double sigma_m) {
  MapMeasurement m;
  m.utime = pose.utime - 400'000;
  m.T_map_odom = planar(pose.T_map_odom);
  m.T_map_odom.x_m += x_m;
  m.T_map_odom.yaw_rad += yaw_rad;
  m.cov = Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 1e-4).asDiagonal();
  return m;
}

TEST(Localization, CorrectionMovesMapAgainstOdom) {
  SyntheticDrive drive({}, 17);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(20.0);
  const PoseEstimate before = drive.localization.pose();
  MapMeasurement m = offset_measurement(before, 0.4, 0.02, 0.1);
  EXPECT_EQ(drive.localization.apply_correction(m), "");
  drive.run(0.02);
  const PoseEstimate after = drive.localization.pose();
  EXPECT_LT((after.T_odom_body.translation() - before.T_odom_body.translation()).norm(), 0.006);
  EXPECT_GT((after.T_map_odom.translation() - before.T_map_odom.translation()).norm(), 0.2);
  EXPECT_LT(after.cov(0, 0), before.cov(0, 0));
  EXPECT_NE(drive.localization.apply_correction(m), "") << "repeated";
  m.utime += 200'000;
  m.T_map_odom.x_m += 30.0;
  EXPECT_NE(drive.localization.apply_correction(m), "") << "outside the gate";
}

// The search window of global_localization is 12 m, independent of the pose's covariance, which must then grow.
TEST(Localization, CorrectionOutsideGateIsAcceptedWithInflatedCovariance) {
  SyntheticDrive drive({}, 17);
  drive.command = arc;
  drive.align_and_start(0.1, 0.005);
  drive.run(20.0);
  const PoseEstimate before = drive.localization.pose();
  ASSERT_LT(std::sqrt(before.cov(0, 0)), 0.5);
  EXPECT_EQ(drive.localization.apply_correction(offset_measurement(before, 6.0, 0.0, 0.3)), "");
  drive.run(0.02);
  const PoseEstimate after = drive.localization.pose();
  EXPECT_NEAR(after.T_map_odom.translation().x(), before.T_map_odom.translation().x() + 6.0, 0.2);
  EXPECT_GT(std::sqrt(after.cov(0, 0)), 0.2) << "no better than the correction";
  EXPECT_LT(std::sqrt(after.cov(0, 0)), 0.4);
}

// A start pose that is off by much and says so: mission_control's locate, and global_localization's fix.
TEST(Localization, ALostRoverTakesAFixFromFarOff) {
  SyntheticDrive drive({}, 17);
  drive.command = arc;
  drive.align_and_start(0.1, 0.005);
  drive.run(20.0);
  const PoseEstimate before = drive.localization.pose();
  const Eigen::Isometry3d T_map_body = before.T_map_odom * before.T_odom_body;
  EXPECT_EQ(drive.localization.set_start_pose(
                {T_map_body.translation(), rpy_of(T_map_body.linear()).z(), 500.0 / 3.0, to_rad(3.0)}),
            "");
  drive.run(1.0);
  const PoseEstimate lost = drive.localization.pose();
  EXPECT_NEAR(std::sqrt(lost.cov(0, 0)), 500.0 / 3.0, 1.0);
  EXPECT_EQ(drive.localization.apply_correction(offset_measurement(lost, 300.0, 0.05, 0.3)), "");
  drive.run(0.02);
  const PoseEstimate found = drive.localization.pose();
  EXPECT_NEAR(std::abs(found.T_map_odom.translation().x() - lost.T_map_odom.translation().x()), 300.0, 1.0);
  EXPECT_LT(std::sqrt(found.cov(0, 0)), 0.5);
  EXPECT_LT((found.T_odom_body.translation() - lost.T_odom_body.translation()).norm(), 0.02);
}

// SLAM moves map by 0.3 m against odom within 5 s.
double map_moved_by_slam(bool visual) {
  LocalizationConfig config;
  SyntheticDrive drive(config, 18);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(20.0);
  const PoseEstimate before = drive.localization.pose();
  MapMeasurement m;
  m.T_map_odom = planar(before.T_map_odom);
  m.cov = Vector3d(1e-6, 1e-6, 1e-8).asDiagonal();
  const auto add_slam_pose = [&] {
    m.utime = drive.localization.pose().utime - 400'000;
    EXPECT_EQ(drive.localization.add_slam_pose(m), "");
  };
  add_slam_pose();
  drive.visual_on = visual;
  drive.run(5.0);
  m.T_map_odom.x_m += 0.3;
  add_slam_pose();
  Eigen::Isometry3d last = drive.localization.pose().T_map_odom;
  drive.run(20.0, [&] {
    const Eigen::Isometry3d T = drive.localization.pose().T_map_odom;
    EXPECT_LT((T.translation() - last.translation()).norm(), 1.01 * config.map.slam_rate_mps * 0.02);
    last = T;
  });
  return last.translation().x() - before.T_map_odom.translation().x();
}

TEST(Localization, SlamMovesMapWhereWheelsBridgedVisualOdometry) {
  EXPECT_NEAR(map_moved_by_slam(false), 0.3, 0.01);
  EXPECT_LT(map_moved_by_slam(true), 0.1);
}

TEST(Localization, SlamBridgesVisualOdometryForAnyDistance) {
  for (const bool slam : {false, true}) {
    SyntheticDrive drive({}, 25);
    drive.command = arc;
    drive.align_and_start(0.5, 0.05);
    drive.run(10.0);
    drive.visual_on = false;
    for (int i = 0; i < 10; ++i) {
      drive.run(2.5);
      MapMeasurement m;
      m.utime = drive.localization.pose().utime - 400'000;
      m.T_map_odom = planar(drive.localization.pose().T_map_odom);
      m.cov = Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
      if (slam) {
        EXPECT_EQ(drive.localization.add_slam_pose(m), "");
      }
    }
    EXPECT_EQ(drive.localization.pose().status, slam ? PoseStatus::kDegraded : PoseStatus::kLost);
  }
}

// Odometry on wheels alone; SLAM matches a cloud each 2.5 s.
void drive_with_slam(SyntheticDrive& drive, int clouds, bool position_observable = true) {
  for (int i = 0; i < clouds; ++i) {
    drive.run(2.5);
    MapMeasurement m;
    m.utime = drive.localization.pose().utime - 400'000;
    m.T_map_odom = planar(drive.localization.pose().T_map_odom);
    m.cov = Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    m.position_observable = position_observable;
    EXPECT_EQ(drive.localization.add_slam_pose(m), "");
  }
}

TEST(Localization, ReturnOfVisualOdometryDoesNotUndoWhatSlamMeasured) {
  SyntheticDrive drive({}, 25);
  drive.command = arc;
  drive.align_and_start(0.01, 0.001);
  drive.run(10.0);
  const Utime out = drive.now();
  Utime back = out + to_utime(3600.0);
  drive.corrupt_visual = [&](VisualMotion& m) {
    if (m.utime > out && m.previous_utime < back) m.status = VisualStatus::kLost;
  };
  drive_with_slam(drive, 20);
  const auto sigma_m = [&] { return std::sqrt(drive.localization.pose().cov(0, 0)); };
  const double before_m = sigma_m();
  back = drive.now();
  drive.run(2.0);
  ASSERT_EQ(drive.localization.pose().status, PoseStatus::kOk);
  EXPECT_NEAR(sigma_m(), before_m, 0.1 * before_m);
}

TEST(Localization, SlamThatKnowsOneDirectionOnlyMeasuresNoDistance) {
  SyntheticDrive drive({}, 25);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(10.0);
  drive.visual_on = false;
  drive_with_slam(drive, 5, false);
  EXPECT_EQ(drive.localization.pose().reason, "too far on wheels alone");
}

// Longer than the history of motions.
TEST(Localization, WheelsAreNotForgottenWhileNoVisualOdometryComes) {
  SyntheticDrive drive({}, 26);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(10.0);
  drive.visual_on = false;
  drive.run(90.0);
  const Vector3d before = drive.localization.pose().T_odom_body.translation();
  drive.visual_on = true;
  drive.run(3.0);
  EXPECT_LT((drive.localization.pose().T_odom_body.translation() - before).norm(), 1.0);
}

TEST(Localization, ContinuesFromCheckpoint) {
  SyntheticDrive drive({}, 19);
  drive.command = [](double t) { return t < 1.5 || t > 21.5 ? Twist{} : Twist{0.2, 0.05}; };
  drive.align_and_start();
  drive.run(10.0);
  const auto bytes = to_bytes(*drive.localization.checkpoint());
  const PoseEstimate before = drive.localization.pose();
  drive.run(1.0, [&] {});  // the process is down
  const auto checkpoint = from_bytes(bytes);
  ASSERT_TRUE(checkpoint.has_value());
  drive.localization = Localization(LocalizationConfig{}, test_vehicle());
  drive.localization.restore(*checkpoint);
  drive.run(0.1);
  EXPECT_GE(drive.localization.pose().last_vo_utime, before.last_vo_utime)
      << "otherwise the vo_age fault stops the rover";
  drive.run(4.9);
  const PoseEstimate after = drive.localization.pose();
  EXPECT_EQ(after.status, PoseStatus::kOk);
  EXPECT_GT(after.travelled_m, before.travelled_m + 1.0);
  EXPECT_LT((after.T_map_odom.matrix() - before.T_map_odom.matrix()).norm(), 1e-12);
  EXPECT_LT(position_error(drive), 0.05);
}

// A process that continues from the checkpoint of the running one at once, for the same inputs.
void restart(SyntheticDrive& drive) {
  const auto checkpoint = from_bytes(to_bytes(*drive.localization.checkpoint()));
  ASSERT_TRUE(checkpoint.has_value());
  drive.localization = Localization(short_alignment({}), test_vehicle());
  drive.localization.restore(*checkpoint);
}

TEST(Localization, RestoredCheckpointKeepsTractionAndSideSlip) {
  SyntheticDrive uninterrupted({}, 21);
  SyntheticDrive restarted({}, 21);
  for (SyntheticDrive* drive : {&uninterrupted, &restarted}) {
    drive->command = [](double t) { return t < 1.5 ? Twist{} : Twist{0.2, 0.0}; };
    drive->slip = [](double) { return 0.4; };
    // On a side slope the rover crabs to the left.
    drive->corrupt_visual = [](VisualMotion& m) { m.T_prev_cur.translation().y() += 0.005; };
    drive->align_and_start();
    drive->run(15.0);
    drive->visual_on = false;
    drive->run(0.5);
  }
  const double travelled_m = restarted.localization.pose().travelled_m;
  restart(restarted);
  uninterrupted.run(4.0);
  restarted.run(4.0);
  const PoseEstimate& expected = uninterrupted.localization.pose();
  const PoseEstimate& pose = restarted.localization.pose();
  ASSERT_GT(expected.travelled_m, travelled_m + 0.4);
  EXPECT_LT((pose.T_odom_body.translation() - expected.T_odom_body.translation()).norm(), 1e-6);
  EXPECT_LT((pose.velocity_body_mps - expected.velocity_body_mps).norm(), 1e-9);
  EXPECT_LT(log_so3(pose.T_odom_body.linear().transpose() * expected.T_odom_body.linear()).norm(), 1e-6);
  EXPECT_LT((pose.cov - expected.cov).norm(), 1e-6 * expected.cov.norm());
  EXPECT_FALSE(restarted.localization.slip().valid) << "the window starts anew";
}

TEST(Localization, SuspectGyroStaysSuspectAfterRestart) {
  SyntheticDrive drive({}, 22);
  drive.command = arc;
  drive.align_and_start();
  drive.run(10.0);
  drive.corrupt_imu = [](ImuSample& s) { s.fog_delta_yaw_rad += 0.1 * s.dt_s; };
  drive.run(20.0);
  ASSERT_EQ(drive.localization.pose().reason, "gyro contradicts visual odometry");
  restart(drive);
  drive.run(1.0, [&] { EXPECT_EQ(drive.localization.pose().reason, "gyro contradicts visual odometry"); });
  EXPECT_EQ(drive.localization.pose().status, PoseStatus::kDegraded);
}

TEST(Localization, RestartExtendsNeitherDeadReckoningNorTimeWithoutImu) {
  for (const bool imu : {true, false}) {
    SyntheticDrive drive({}, 23);
    drive.command = arc;
    drive.align_and_start();
    drive.run(10.0);
    (imu ? drive.visual_on : drive.imu_on) = false;
    drive.run(15.0);
    const std::string_view reason = imu ? "too far on wheels alone" : "no IMU for too long";
    ASSERT_EQ(drive.localization.pose().reason, reason);
    restart(drive);
    drive.run(0.5, [&] { EXPECT_EQ(drive.localization.pose().reason, reason); });
  }
}

// SLAM's motion since the cloud before is lost with the old process.
TEST(Localization, FirstSlamPoseAfterRestartMeasuresNoDistance) {
  SyntheticDrive drive({}, 25);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(10.0);
  drive.visual_on = false;
  const auto dead_reckoned_after_cloud_m = [&] {
    drive_with_slam(drive, 1);
    drive.run(1.5);
    return drive.localization.checkpoint()->dead_reckoned_m;
  };
  dead_reckoned_after_cloud_m();
  const double before_m = dead_reckoned_after_cloud_m();
  restart(drive);
  EXPECT_GT(dead_reckoned_after_cloud_m(), before_m + 0.5);
  EXPECT_NEAR(dead_reckoned_after_cloud_m(), before_m, 0.01);
}

TEST(Localization, MapMeasurementWithinAGapOfThePoseIsRejected) {
  SyntheticDrive drive({}, 24);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(10.0);
  drive.process_stalled = true;
  drive.run(1.0);
  drive.process_stalled = false;
  drive.run(0.5);
  MapMeasurement m;
  m.T_map_odom = planar(drive.localization.pose().T_map_odom);
  m.cov = Vector3d(0.04, 0.04, 1e-4).asDiagonal();
  m.utime = drive.now() - 1'000'000;
  EXPECT_NE(drive.localization.add_slam_pose(m), "");
  EXPECT_NE(drive.localization.apply_correction(m), "");
  m.utime = drive.now() - 210'000;
  EXPECT_EQ(drive.localization.apply_correction(m), "") << "between two ticks";
}

TEST(Localization, SlamPoseOlderThanCorrectionIsRejectedAfterRestart) {
  SyntheticDrive drive({}, 24);
  drive.command = arc;
  drive.align_and_start(0.5, 0.05);
  drive.run(10.0);
  MapMeasurement m;
  m.utime = drive.localization.pose().utime - 400'000;
  m.T_map_odom = planar(drive.localization.pose().T_map_odom);
  m.cov = Vector3d(0.04, 0.04, 1e-4).asDiagonal();
  MapMeasurement slam_pose = m;
  slam_pose.utime -= 100'000;
  ASSERT_EQ(drive.localization.apply_correction(m), "");
  restart(drive);
  drive.run(0.1);
  EXPECT_NE(drive.localization.add_slam_pose(slam_pose), "");
  EXPECT_NE(drive.localization.apply_correction(m), "") << "the same correction again";
}

TEST(Localization, SameInputsGiveSameBytes) {
  SyntheticDrive a({}, 20);
  SyntheticDrive b({}, 20);
  for (SyntheticDrive* drive : {&a, &b}) {
    drive->command = arc;
    drive->align_and_start();
    drive->run(20.0);
  }
  EXPECT_EQ(to_bytes(*a.localization.checkpoint()), to_bytes(*b.localization.checkpoint()));
}

}  // namespace
}  // namespace rover::loc
