#include "tools/report/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rover::report {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Half a step off the samples, so that rounding does not matter.
const std::vector<double> kLengths = {9.5, 19.5, 29.5, 39.5, 49.5};

// A curve of `length_m` in 1 m steps: truth, and an estimate with scale and heading error in its own frame.
std::vector<PosePair> curve(int length_m, double scale, double turn_rad) {
  const Isometry3d T_own = make_pose(rotation_from_rpy(0.1, -0.2, 1.3), {5.0, -7.0, 2.0});
  Isometry3d truth = Isometry3d::Identity();
  Isometry3d estimate = Isometry3d::Identity();
  std::vector<PosePair> poses;
  for (int i = 0; i <= length_m; ++i) {
    poses.push_back({truth, T_own * estimate});
    truth = truth * make_pose(rotation_from_rpy(0.0, 0.0, 0.02), {1.0, 0.0, 0.0});
    estimate = estimate * make_pose(rotation_from_rpy(0.0, 0.0, 0.02 + turn_rad), {scale, 0.0, 0.0});
  }
  return poses;
}

TEST(TrajectoryError, IsZeroForSameTrajectoryInAnotherFrame) {
  const TrajectoryError error = trajectory_error(curve(60, 1.0, 0.0), kLengths);
  EXPECT_EQ(error.poses, 61);
  EXPECT_NEAR(error.length_m, 60.0, 1e-9);
  EXPECT_NEAR(error.end_error_percent, 0.0, 1e-9);
  EXPECT_NEAR(error.ate_rmse_m, 0.0, 1e-9);
  ASSERT_EQ(error.segments.size(), 5U);
  EXPECT_EQ(error.segments[0].count, 51);
  EXPECT_EQ(error.segments[4].count, 11);
  EXPECT_NEAR(error.all_segments.translation_percent, 0.0, 1e-9);
}

TEST(TrajectoryError, FindsAnErrorOfScale) {
  // Straight, so that segment errors equal the scale error.
  std::vector<PosePair> poses;
  for (int i = 0; i <= 60; ++i)
    poses.push_back({make_pose(Eigen::Matrix3d::Identity(), {1.0 * i, 0, 0}),
                     make_pose(Eigen::Matrix3d::Identity(), {1.02 * i, 0, 0})});
  const TrajectoryError error = trajectory_error(poses);
  EXPECT_NEAR(error.end_error_percent, 2.0, 1e-9);
  for (const SegmentError& segment : error.segments) EXPECT_NEAR(segment.translation_percent, 2.0, 1e-9);
  EXPECT_NEAR(error.all_segments.rotation_deg_per_m, 0.0, 1e-9);
  // Rigid alignment matches the centroids: errors are 2 % of the distance from there.
  double sum2 = 0.0;
  for (int i = -30; i <= 30; ++i) sum2 += std::pow(0.02 * i, 2);
  EXPECT_NEAR(error.ate_rmse_m, std::sqrt(sum2 / 61.0), 1e-9);
  EXPECT_NEAR(error.ate_max_m, 0.6, 1e-9);
}

TEST(TrajectoryError, FindsAnErrorOfHeading) {
  const double turn_rad = to_rad(0.01);
  const TrajectoryError error = trajectory_error(curve(60, 1.0, turn_rad), kLengths);
  for (const SegmentError& segment : error.segments)
    EXPECT_NEAR(segment.rotation_deg_per_m, 0.01 * (segment.length_m + 0.5) / segment.length_m, 1e-9);
  EXPECT_GT(error.end_error_m, 0.1);
  EXPECT_LT(error.ate_rmse_m, error.end_error_m);
}

TEST(TrajectoryError, LengthsBeyondTheTrajectoryHaveNoFigure) {
  const TrajectoryError error = trajectory_error(curve(25, 1.0, 0.0), kLengths);
  EXPECT_EQ(error.segments[1].count, 6);
  EXPECT_EQ(error.segments[2].count, 0);
  EXPECT_TRUE(std::isnan(error.segments[2].translation_percent));
  EXPECT_TRUE(std::isnan(trajectory_error({}).end_error_m));
}

RunRecord seen_run(const std::vector<bool>& lost) {
  RunRecord run;
  for (size_t i = 0; i <= lost.size(); ++i) {
    TruthSample truth;
    truth.t_s = static_cast<double>(i);
    truth.T_map_body.translation().x() = static_cast<double>(i);
    run.truth.push_back(truth);
  }
  double from_s = 0.0;
  for (size_t i = 0; i < lost.size(); ++i) {
    const double to_s = static_cast<double>(i + 1);
    VisualSample motion{from_s, to_s, lost[i], nan_pose()};
    if (!lost[i]) motion.T_from_to = make_pose(Eigen::Matrix3d::Identity(), {to_s - from_s, 0, 0});
    run.visual.push_back(motion);
    if (!lost[i]) from_s = to_s;
  }
  return run;
}

TEST(VisualPoses, AMotionAfterALostPairSpansIt) {
  const RunRecord run = seen_run({false, true, false});
  const auto poses = visual_poses(run, TrueTrack(run.truth));
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_NEAR(trajectory_error(poses).end_error_m, 0.0, 1e-12);
}

TEST(VisualPoses, UnobservedMotionCountsAsError) {
  RunRecord run = seen_run({false, false, false});
  run.visual.erase(run.visual.begin() + 1);
  EXPECT_NEAR(trajectory_error(visual_poses(run, TrueTrack(run.truth))).end_error_m, 1.0, 1e-12);
}

// Ground truth that starts late, ends early or has a gap: poses without truth are not evaluated.
TEST(VisualPoses, AreEvaluatedOnlyWhereTruthIsKnown) {
  RunRecord run = seen_run(std::vector<bool>(20, false));
  run.truth.erase(run.truth.begin(), run.truth.begin() + 5);
  run.truth.erase(run.truth.end() - 4, run.truth.end());
  run.truth.erase(run.truth.begin() + 3, run.truth.begin() + 5);
  const auto poses = visual_poses(run, TrueTrack(run.truth));
  ASSERT_EQ(poses.size(), 10U);
  EXPECT_NEAR(trajectory_error(poses).end_error_m, 0.0, 1e-12);
  EXPECT_NEAR(trajectory_error(poses).length_m, 11.0, 1e-12);
}

}  // namespace
}  // namespace rover::report
