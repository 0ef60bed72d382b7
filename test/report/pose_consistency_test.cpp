#include "tools/report/pose_consistency.hpp"

#include <gtest/gtest.h>

#include <random>

#include "known_run.hpp"
#include "tools/report/convert.hpp"

namespace rover::report {
namespace {

// A straight drive whose estimate errs by `error` (x, y, yaw in map), with a covariance.
RunRecord biased_run(const Eigen::Vector3d& error, const Eigen::Matrix3d& cov, double length_m = 20.0) {
  RunRecord run = straight_run(length_m);
  for (PoseSample& pose : run.poses) {
    const Eigen::Vector3d p = pose.T_odom_body.translation() + Eigen::Vector3d(error.x(), error.y(), 0.0);
    pose.T_odom_body = make_pose(rotation_from_rpy(0.0, 0.0, error.z()), p);
    pose.cov_xyyaw = cov;
  }
  return run;
}

PoseConsistency whole_drive(const RunRecord& run) {
  return pose_consistency(run, TrueTrack(run.truth), drive_window(run));
}

TEST(PoseConsistency, NormalisesErrorsByTheirCovariance) {
  const Eigen::Vector3d sigma(0.2, 0.1, 0.01);
  const Eigen::Vector3d error(0.2, -0.3, 0.005);
  const PoseConsistency pose = whole_drive(biased_run(error, sigma.cwiseAbs2().asDiagonal()));
  EXPECT_EQ(pose.samples, 201) << "once a second over 200 s";
  EXPECT_NEAR(pose.x, 1.0, 1e-9);
  EXPECT_NEAR(pose.y, 9.0, 1e-9);
  EXPECT_NEAR(pose.yaw, 0.25, 1e-9);
  EXPECT_NEAR(pose.xyyaw, (1.0 + 9.0 + 0.25) / 3.0, 1e-9);
}

TEST(PoseConsistency, ErrorAlongACorrelationIsMoreConsistent) {
  Eigen::Matrix3d cov = Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal();
  cov(0, 1) = cov(1, 0) = 0.036;
  const double along = whole_drive(biased_run({0.2, 0.2, 0.0}, cov)).xyyaw;
  const double against = whole_drive(biased_run({0.2, -0.2, 0.0}, cov)).xyyaw;
  EXPECT_NEAR(along, 0.08 / (0.04 + 0.036) / 3.0, 1e-9);
  EXPECT_NEAR(against, 0.08 / (0.04 - 0.036) / 3.0, 1e-9);
}

TEST(PoseConsistency, ConsistentRunsHaveAMeanOfOne) {
  Eigen::Matrix3d cov;
  cov << 0.05, 0.02, 0.001, 0.02, 0.03, -0.0005, 0.001, -0.0005, 1e-4;
  const Eigen::Matrix3d root = cov.llt().matrixL();
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  constexpr int kRuns = 400;
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::Vector3d error = root * Eigen::Vector3d{normal(random), normal(random), normal(random)};
    const PoseConsistency pose = whole_drive(biased_run(error, cov, 1.0));
    mean += Eigen::Vector4d(pose.x, pose.y, pose.yaw, pose.xyyaw) / kRuns;
  }
  // Three standard deviations of the mean of 400 runs.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean[i], 1.0, 0.22) << i;
  EXPECT_NEAR(mean[3], 1.0, 0.13);
}

TEST(PoseConsistency, YawErrorIsAboutTheVerticalOnASlope) {
  RunRecord run = biased_run(Eigen::Vector3d::Zero(), Eigen::Vector3d(1.0, 1.0, 1e-4).asDiagonal());
  const Eigen::Matrix3d tilt = rotation_from_rpy(0.1, 0.2, 1.5);
  for (TruthSample& truth : run.truth) truth.T_map_body.linear() = rotation_from_rpy(0.0, 0.0, 0.02) * tilt;
  for (PoseSample& pose : run.poses) pose.T_odom_body.linear() = tilt;
  EXPECT_NEAR(whole_drive(run).yaw, 4.0, 1e-6);
}

TEST(PoseConsistency, CountsBeforeAndAfterTheFirstAcceptedCorrectionApart) {
  const Eigen::Matrix3d cov = Eigen::Vector3d(0.25, 0.25, 1e-4).asDiagonal();
  RunRecord run = biased_run({1.0, 0.0, 0.0}, cov);
  for (PoseSample& pose : run.poses)
    if (pose.t_s >= 100.0) pose.T_odom_body.translation().x() -= 0.75;
  EXPECT_EQ(figures(run).anees_after_fix.samples, 0);
  run.corrections = {{40.0, false, {}, 41.0, "flat"}, {98.0, true, {}, 99.7}};
  const Metrics m = figures(run);
  EXPECT_NEAR(m.anees.x, 4.0, 1e-9);
  EXPECT_NEAR(m.anees_after_fix.x, 0.25, 1e-9);
  EXPECT_EQ(m.anees.samples + m.anees_after_fix.samples, 201);
}

TEST(PoseConsistency, ReadsXYYawOfThePublishedCovariance) {
  pose_t message{};
  for (int i = 0; i < 36; ++i) message.covariance[i] = i;
  Eigen::Matrix3d expected;
  expected << 0, 1, 5, 6, 7, 11, 30, 31, 35;
  EXPECT_EQ(pose_from(message).cov_xyyaw, expected);
}

TEST(PoseConsistency, UnknownCovarianceOrTruthGivesNoFigure) {
  EXPECT_EQ(whole_drive(straight_run(5.0)).samples, 0);
  EXPECT_EQ(whole_drive(biased_run(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero())).samples, 0);
  RunRecord blind = biased_run(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  blind.truth.clear();
  EXPECT_TRUE(std::isnan(pose_consistency(blind, TrueTrack({}), {0.0, 100.0}).xyyaw));
}

}  // namespace
}  // namespace rover::report
