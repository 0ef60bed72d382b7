// Behaviour of visual odometry on synthetic ground.
#include "visual_odometry/odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_ground.hpp"

namespace rover::vo {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Utime kPeriod = 400'000;

// Drives along poses and composes the motions.
struct Drive {
  SyntheticGround ground;
  Odometry odometry;
  std::vector<OdometryResult> results;
  Isometry3d T_world_body = Isometry3d::Identity();  // estimate, initialised with ground truth
  Isometry3d truth = Isometry3d::Identity();
  Utime now = 0;

  explicit Drive(std::uint64_t seed, const OdometryConfig& config = {}) : ground(seed), odometry(config) {}

  std::optional<OdometryResult> drive_to(const Isometry3d& pose) {
    now += kPeriod;
    if (results.empty() && odometry.previous_utime() == kNever) T_world_body = pose;
    truth = pose;
    const auto result = odometry.step(ground.frame(now, pose));
    if (!result) return result;
    results.push_back(*result);
    if (is_finite(result->T_prev_cur)) T_world_body = T_world_body * result->T_prev_cur;
    return result;
  }
  double error_m() const { return (T_world_body.translation() - truth.translation()).norm(); }
  double error_rad() const { return log_so3(T_world_body.linear().transpose() * truth.linear()).norm(); }
};

Isometry3d along_arc(double s, double curvature = 0.15) {
  const double yaw = curvature * s;
  return SyntheticGround::over_ground(std::sin(yaw) / curvature, (1.0 - std::cos(yaw)) / curvature, yaw,
                                      0.02 * std::sin(2.0 * s), 0.03 * std::sin(3.0 * s));
}

TEST(Odometry, FirstPairGivesNoMotion) {
  Drive drive(1);
  EXPECT_FALSE(drive.drive_to(along_arc(0.0)).has_value());
  EXPECT_EQ(drive.odometry.previous_utime(), kPeriod);
}

TEST(Odometry, DriftBelowHalfPercentOnArc) {
  Drive drive(1);
  for (int i = 0; i <= 50; ++i) drive.drive_to(along_arc(0.08 * i));
  for (const OdometryResult& r : drive.results) EXPECT_EQ(r.status, Status::kOk);
  EXPECT_LT(drive.error_m(), 0.005 * 4.0);
  EXPECT_LT(drive.error_rad(), 0.004);
}

TEST(Odometry, MotionsCoverAllExposures) {
  Drive drive(2);
  for (int i = 0; i <= 10; ++i) drive.drive_to(along_arc(0.08 * i));
  ASSERT_EQ(drive.results.size(), 10U);
  for (size_t i = 0; i < drive.results.size(); ++i) {
    EXPECT_EQ(drive.results[i].previous_utime, static_cast<Utime>(i + 1) * kPeriod);
    EXPECT_LE(drive.results[i].keyframe_utime, drive.results[i].previous_utime);
  }
}

TEST(Odometry, NoDriftAtStandstill) {
  Drive drive(3);
  double largest = 0.0;
  for (int i = 0; i < 60; ++i) {
    drive.drive_to(along_arc(0.0));
    largest = std::max(largest, drive.error_m());
  }
  EXPECT_LT(largest, 0.001);
  EXPECT_LT(drive.error_rad(), 0.001);
  for (const OdometryResult& r : drive.results) EXPECT_EQ(r.keyframe_utime, kPeriod) << "keyframe is not replaced";
}

TEST(Odometry, TracksPointTurn) {
  Drive drive(4);
  for (int i = 0; i <= 30; ++i) drive.drive_to(SyntheticGround::over_ground(1.0, 0.0, 0.1 * std::max(0, i - 1)));
  for (const OdometryResult& r : drive.results) EXPECT_NE(r.status, Status::kLost);
  EXPECT_LT(drive.error_m(), 0.03);
  EXPECT_LT(drive.error_rad(), 0.02);
}

TEST(Odometry, FastFirstMotionWithoutPrediction) {
  Drive drive(5);
  drive.drive_to(SyntheticGround::over_ground(0.0, 0.0, 0.0));
  const auto result = drive.drive_to(SyntheticGround::over_ground(0.10, 0.01, 0.06));
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->status, Status::kOk);
  EXPECT_LT(drive.error_m(), 0.002);
}

TEST(Odometry, GyroPredictionTracksLargeRotation) {
  const Isometry3d a = SyntheticGround::over_ground(0.0, 0.0, 0.0);
  const Isometry3d b = SyntheticGround::over_ground(0.0, 0.0, 0.45);
  SyntheticGround ground(6);
  Odometry with_gyro(OdometryConfig{});
  with_gyro.step(ground.frame(1, a));
  StereoFrame frame = ground.frame(2, b);
  frame.R_prev_cur = a.linear().transpose() * b.linear();
  const auto result = with_gyro.step(frame);
  ASSERT_TRUE(result.has_value());
  ASSERT_NE(result->status, Status::kLost);
  EXPECT_LT((result->T_prev_cur.translation() - (a.inverse() * b).translation()).norm(), 0.01);
}

TEST(Odometry, WrongGyroGivesDegradedButCorrectMotion) {
  SyntheticGround ground(7);
  Odometry odometry(OdometryConfig{});
  odometry.step(ground.frame(kPeriod, along_arc(0.0)));
  StereoFrame frame = ground.frame(2 * kPeriod, along_arc(0.08));
  frame.R_prev_cur = exp_so3(Vector3d(0.0, 0.0, 0.5));
  const auto result = odometry.step(frame);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->status, Status::kDegraded) << "images and gyro disagree";
  const Isometry3d given = along_arc(0.0).inverse() * along_arc(0.08);
  EXPECT_LT((result->T_prev_cur.translation() - given.translation()).norm(), 0.002);
}

TEST(Odometry, MotionAfterLostFrameSpansIt) {
  Drive drive(8);
  for (int i = 0; i <= 5; ++i) drive.drive_to(along_arc(0.08 * i));
  drive.ground.textureless = true;
  const auto failed = drive.drive_to(along_arc(0.48));
  drive.ground.textureless = false;
  ASSERT_TRUE(failed.has_value());
  EXPECT_EQ(failed->status, Status::kLost);
  EXPECT_FALSE(failed->cov.allFinite());
  EXPECT_FALSE(is_finite(failed->T_prev_cur));
  const auto next = drive.drive_to(along_arc(0.56));
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->status, Status::kOk);
  EXPECT_EQ(next->previous_utime, failed->utime - kPeriod) << "spans the failed frame";
  EXPECT_LT(drive.error_m(), 0.005);
}

TEST(Odometry, LongLossRestartsWithNewKeyframe) {
  Drive drive(9);
  for (int i = 0; i <= 5; ++i) drive.drive_to(along_arc(0.08 * i));
  drive.ground.textureless = true;
  for (int i = 6; i <= 40; ++i) EXPECT_EQ(drive.drive_to(along_arc(0.08 * i))->status, Status::kLost);
  drive.ground.textureless = false;
  // No keyframe point is visible: lost, then motions from a new keyframe.
  OdometryResult last;
  int lost = 0;
  for (int i = 41; i <= 46; ++i) {
    last = *drive.drive_to(along_arc(0.08 * i));
    lost += last.status == Status::kLost;
  }
  EXPECT_GE(lost, 1);
  EXPECT_LE(lost, 2);
  EXPECT_EQ(last.status, Status::kOk);
  EXPECT_EQ(last.previous_utime, last.utime - kPeriod);
}

TEST(Odometry, TexturelessStartIsLost) {
  Drive drive(10);
  drive.ground.textureless = true;
  const auto result = drive.drive_to(along_arc(0.0));
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->status, Status::kLost);
  drive.ground.textureless = false;
  EXPECT_FALSE(drive.drive_to(along_arc(0.0)).has_value());
}

TEST(Odometry, ExposureChangeIsTolerated) {
  Drive drive(11);
  for (int i = 0; i <= 12; ++i) {
    drive.ground.gain = i % 2 ? 0.6 : 1.3;
    drive.drive_to(along_arc(0.08 * i));
  }
  for (const OdometryResult& r : drive.results) EXPECT_EQ(r.status, Status::kOk);
  EXPECT_LT(drive.error_m(), 0.01);
}

TEST(Odometry, BlurredFrameIsTolerated) {
  Drive drive(12);
  for (int i = 0; i <= 12; ++i) {
    drive.ground.blur_px = i == 6 ? 2.0 : 0.0;
    drive.drive_to(along_arc(0.08 * i));
  }
  EXPECT_LT(drive.error_m(), 0.01);
}

// A third of the image moves with the rover, like its shadow.
TEST(Odometry, RoverShadowIsRejectedAsOutlier) {
  Drive drive(13);
  cv::RNG rng(5);
  cv::Mat shadow(130, 512, CV_8UC1);
  rng.fill(shadow, cv::RNG::UNIFORM, 40, 160);
  cv::GaussianBlur(shadow, shadow, {}, 1.5);
  Utime now = 0;
  Isometry3d T = along_arc(0.0);
  for (int i = 0; i <= 12; ++i) {
    StereoFrame frame = drive.ground.frame(now += kPeriod, along_arc(0.08 * i));
    for (int y = 0; y < shadow.rows; ++y)
      for (int x = 0; x < shadow.cols; ++x) {
        frame.left.at(x, 254 + y) = shadow.at<std::uint8_t>(y, x);
        frame.right.at(x, 254 + y) = shadow.at<std::uint8_t>(y, std::min(x + 40, 511));
      }
    if (const auto result = drive.odometry.step(frame); result && result->status != Status::kLost)
      T = T * result->T_prev_cur;
  }
  EXPECT_LT((T.translation() - along_arc(0.96).translation()).norm(), 0.02);
}

TEST(Odometry, DenseDisparitySeedDoesNotChangeMotion) {
  SyntheticGround a(14);
  SyntheticGround b(14);
  Odometry plain(OdometryConfig{});
  Odometry seeded(OdometryConfig{});
  Isometry3d T_unseeded = Isometry3d::Identity();
  Isometry3d T_seeded = Isometry3d::Identity();
  for (int i = 0; i <= 12; ++i) {
    const Isometry3d pose = along_arc(0.08 * i);
    if (const auto r = plain.step(a.frame((i + 1) * kPeriod, pose))) T_unseeded = T_unseeded * r->T_prev_cur;
    StereoFrame frame = b.frame((i + 1) * kPeriod, pose);
    frame.disparity = b.ground_disparity(pose);
    if (const auto r = seeded.step(frame)) T_seeded = T_seeded * r->T_prev_cur;
  }
  EXPECT_LT((T_unseeded.translation() - T_seeded.translation()).norm(), 0.005);
}

TEST(Odometry, CalibrationChangeRestartsWithNewKeyframe) {
  Drive drive(15);
  for (int i = 0; i <= 3; ++i) drive.drive_to(along_arc(0.08 * i));
  drive.ground.camera.baseline_m = 0.2;
  EXPECT_EQ(drive.drive_to(along_arc(0.32))->status, Status::kLost);
  drive.drive_to(along_arc(0.40));
  const auto result = drive.drive_to(along_arc(0.48));
  EXPECT_EQ(result->status, Status::kOk);
}

TEST(Odometry, SameInputsGiveSameNumbers) {
  Drive a(16);
  Drive b(16);
  for (int i = 0; i <= 10; ++i) {
    a.drive_to(along_arc(0.08 * i));
    b.drive_to(along_arc(0.08 * i));
  }
  EXPECT_EQ(a.T_world_body.matrix(), b.T_world_body.matrix());
}

TEST(Odometry, EstimatesDisparityOffsetWhileDriving) {
  double drift[2];
  for (const bool enabled : {false, true}) {
    OdometryConfig config;
    config.disparity_offset.information_factor = enabled ? 0.1 : 0.0;
    Drive drive(17, config);
    drive.ground.right_shift_px = 0.3;  // measured disparities are 0.3 px too small
    for (int i = 0; i <= 60; ++i) drive.drive_to(along_arc(0.08 * i));
    drift[enabled] = drive.error_m();
    EXPECT_NEAR(drive.odometry.correction().yaw_px, enabled ? 0.3 : 0.0, 0.12);
  }
  EXPECT_LT(drift[1], 0.6 * drift[0]);
}

// A quarter of a pixel at the left and right border, each.
TEST(Odometry, EstimatesRollAndFocalLengthOfTheOtherCamera) {
  double heading_error_rad[2];
  for (const bool enabled : {false, true}) {
    OdometryConfig config;
    if (!enabled) config.disparity_offset.max_px = config.disparity_offset.information_factor = 0.0;
    Drive drive(19, config);
    drive.ground.right_roll_rad = 0.25 / 256.0;
    drive.ground.right_focal_ratio = 1.0 + 0.25 / 256.0;
    for (int i = 0; i <= 40; ++i) drive.drive_to(along_arc(0.08 * i));
    EXPECT_NEAR(drive.odometry.correction().roll_px, enabled ? -0.25 : 0.0, 0.05);
    EXPECT_NEAR(drive.odometry.correction().focal_px, enabled ? 0.25 : 0.0, 0.05);
    heading_error_rad[enabled] = drive.error_rad();
  }
  EXPECT_LT(heading_error_rad[1], 0.5 * heading_error_rad[0]);
}

// A knock turns one camera by 0.5 deg: all disparities are wrong by 3.6 px.
TEST(Odometry, NoticesThatTheCamerasHaveMoved) {
  for (const double knock_px : {3.6, -3.6}) {
    Drive drive(25);
    for (int i = 0; i <= 20; ++i) drive.drive_to(along_arc(0.08 * i));
    EXPECT_EQ(drive.results.back().status, Status::kOk);
    drive.ground.right_shift_px = knock_px;
    for (int i = 21; i <= 70; ++i) drive.drive_to(along_arc(0.08 * i));
    EXPECT_EQ(drive.results.back().status, Status::kDisplaced) << knock_px;
    EXPECT_FALSE(is_finite(drive.results.back().T_prev_cur));
    drive.drive_to(SyntheticGround::over_ground(50.0, 50.0, 0.0, 0.0, 0.0));
    EXPECT_EQ(drive.results.back().status, Status::kDisplaced) << "a pair that cannot be registered does not excuse it";
  }
}

TEST(Odometry, DisparityOffsetIsUnobservableAtStandstill) {
  Drive drive(18);
  drive.ground.right_shift_px = 0.3;
  for (int i = 0; i <= 20; ++i) drive.drive_to(along_arc(0.0));
  EXPECT_EQ(drive.odometry.correction().yaw_px, 0.0);
}

// Normalised estimation error squared (NEES) of one motion, averaged.
TEST(Odometry, MeanNeesWithinBounds) {
  double nees = 0.0;
  constexpr int kRuns = 30;
  for (int i = 0; i < kRuns; ++i) {
    Drive drive(static_cast<std::uint64_t>(100 + i));
    drive.ground.camera = loccam();
    drive.drive_to(along_arc(0.05 * i));
    const auto result = drive.drive_to(along_arc(0.05 * i + 0.08));
    ASSERT_EQ(result->status, Status::kOk);
    const Isometry3d given = along_arc(0.05 * i).inverse() * along_arc(0.05 * i + 0.08);
    Eigen::Matrix<double, 6, 1> error;
    error << result->T_prev_cur.translation() - given.translation(),
        log_so3(result->T_prev_cur.linear() * given.linear().transpose());
    nees += error.dot(result->cov.inverse() * error) / kRuns;
  }
  std::cout << "mean NEES " << nees << " of 6\n";
  EXPECT_GT(nees, 1.0);
  EXPECT_LT(nees, 12.0);
}

}  // namespace
}  // namespace rover::vo
