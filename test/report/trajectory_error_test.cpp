#include "tools/report/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rover::report {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Half a step off the samples, so that rounding does not matter.
const SegmentRule kLengths{{9.5, 19.5, 29.5, 39.5, 49.5}};

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
  const TrajectoryError error = trajectory_error(poses, segment_rule(60.0));
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
  EXPECT_NEAR(error.rpe_rmse_deg, 0.01, 1e-9);
  EXPECT_NEAR(error.rpe_rmse_m, 0.0, 1e-9) << "in the frame of the second pose";
  EXPECT_GT(error.end_error_m, 0.1);
  EXPECT_LT(error.ate_rmse_m, error.end_error_m);
}

// The formulas of Geiger et al. 2012 and of evo's relative pose error, computed with matrices on a trajectory of 950 m.
TEST(TrajectoryError, OfALongTrajectoryIsThatOfThePublishedFormulas) {
  std::vector<PosePair> poses = curve(980, 1.004, to_rad(0.02));
  for (PosePair& pose : poses)  // steps that no length is a multiple of
    for (Isometry3d* T : {&pose.truth, &pose.estimate}) T->translation() *= 0.97;
  const TrajectoryError error = trajectory_error(poses, segment_rule(trajectory_length_m(poses)));
  ASSERT_EQ(error.segments.size(), 8U);
  std::vector<double> driven_m = {0.0};
  for (size_t i = 1; i < poses.size(); ++i)
    driven_m.push_back(driven_m.back() + (poses[i].truth.translation() - poses[i - 1].truth.translation()).norm());
  const auto relative = [&](size_t i, size_t j) {
    const Eigen::Matrix4d result = poses[i].estimate.matrix().inverse() * poses[j].estimate.matrix();
    const Eigen::Matrix4d truth = poses[i].truth.matrix().inverse() * poses[j].truth.matrix();
    return Eigen::Matrix4d(result.inverse() * truth);
  };
  double sum_m = 0.0, sum_rad = 0.0, steps_m2 = 0.0;
  int count = 0;
  for (size_t first = 0; first < poses.size(); first += 10)
    for (double length_m = 100.0; length_m <= 800.0; length_m += 100.0) {
      size_t last = first;
      while (last < poses.size() && driven_m[last] <= driven_m[first] + length_m) ++last;
      if (last == poses.size()) continue;
      const Eigen::Matrix4d off = relative(first, last);
      sum_m += off.topRightCorner<3, 1>().norm() / length_m;
      sum_rad += std::acos(0.5 * (off.topLeftCorner<3, 3>().trace() - 1.0)) / length_m;
      ++count;
    }
  EXPECT_EQ(error.all_segments.count, count);
  EXPECT_NEAR(error.all_segments.translation_percent, 100.0 * sum_m / count, 1e-6);
  EXPECT_NEAR(error.all_segments.rotation_deg_per_m, to_deg(sum_rad / count), 1e-6);
  for (size_t i = 1; i < poses.size(); ++i) steps_m2 += relative(i - 1, i).topRightCorner<3, 1>().squaredNorm();
  EXPECT_NEAR(error.rpe_rmse_m, std::sqrt(steps_m2 / 980.0), 1e-9);
}

TEST(TrajectoryError, LengthsBeyondTheTrajectoryHaveNoFigure) {
  const TrajectoryError error = trajectory_error(curve(25, 1.0, 0.0), kLengths);
  EXPECT_EQ(error.segments[1].count, 6);
  EXPECT_EQ(error.segments[2].count, 0);
  EXPECT_TRUE(std::isnan(error.segments[2].translation_percent));
  EXPECT_TRUE(std::isnan(trajectory_error({}, kLengths).end_error_m));
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
  EXPECT_NEAR(trajectory_error(poses, kLengths).end_error_m, 0.0, 1e-12);
}

TEST(VisualPoses, UnobservedMotionCountsAsError) {
  RunRecord run = seen_run({false, false, false});
  run.visual.erase(run.visual.begin() + 1);
  EXPECT_NEAR(trajectory_error(visual_poses(run, TrueTrack(run.truth)), kLengths).end_error_m, 1.0, 1e-12);
}

// Ground truth that starts late, ends early or has a gap: poses without truth are not evaluated.
TEST(VisualPoses, AreEvaluatedOnlyWhereTruthIsKnown) {
  RunRecord run = seen_run(std::vector<bool>(20, false));
  run.truth.erase(run.truth.begin(), run.truth.begin() + 5);
  run.truth.erase(run.truth.end() - 4, run.truth.end());
  run.truth.erase(run.truth.begin() + 3, run.truth.begin() + 5);
  const auto poses = visual_poses(run, TrueTrack(run.truth));
  ASSERT_EQ(poses.size(), 10U);
  EXPECT_NEAR(trajectory_error(poses, kLengths).end_error_m, 0.0, 1e-12);
  EXPECT_NEAR(trajectory_error(poses, kLengths).length_m, 11.0, 1e-12);
}

}  // namespace
}  // namespace rover::report
