#include "tools/report/visual_consistency.hpp"

#include <gtest/gtest.h>

#include <random>

#include "known_run.hpp"

namespace rover::report {
namespace {

constexpr int kPerKeyframe = 4;
const Eigen::Vector<double, 6> kSigma{0.002, 0.001, 0.004, 0.001, 0.002, 0.0005};

// Each second a motion of a turning drive; the alignment with the keyframe errs by `factor` times the stated sigmas.
RunRecord visual_run(int motions, double factor, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  RunRecord run;
  const auto truth_at = [](double t_s) {
    return make_pose(rotation_from_rpy(0.05 * std::sin(t_s), 0.1, 0.2 * t_s), {0.2 * t_s, 0.1 * t_s, 0.0});
  };
  for (int i = 0; i <= 50 * motions; ++i) run.truth.push_back({.t_s = 0.02 * i, .T_map_body = truth_at(0.02 * i)});
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();  // estimate in the keyframe
  for (int i = 0; i < motions; ++i) {
    const double key_s = i / kPerKeyframe * kPerKeyframe;
    if (i % kPerKeyframe == 0) before.setIdentity();
    Eigen::Vector<double, 6> error;
    for (double& e : error) e = normal(random);
    error = factor * error.cwiseProduct(kSigma);
    const Eigen::Isometry3d T_true = truth_at(key_s).inverse() * truth_at(i + 1.0);
    const Eigen::Matrix3d R = before.linear();  // the covariance is in the axes of the earlier body
    const Eigen::Isometry3d T =
        make_pose(exp_so3(R * error.tail<3>()) * T_true.linear(), T_true.translation() + R * error.head<3>());
    VisualSample motion;
    motion.from_s = i;
    motion.to_s = i + 1.0;
    motion.keyframe_s = key_s;
    motion.T_from_to = before.inverse() * T;
    motion.cov = kSigma.cwiseAbs2().asDiagonal();
    run.visual.push_back(motion);
    before = T;
  }
  return run;
}

VisualConsistency of(const RunRecord& run) {
  return visual_consistency(run, TrueTrack(run.truth));
}

TEST(VisualConsistency, StatedCovariancesGiveOne) {
  const VisualConsistency found = of(visual_run(1200, 1.0, 3));
  EXPECT_EQ(found.keyframes, 300);
  EXPECT_NEAR(found.translation, 1.0, 0.15);
  EXPECT_NEAR(found.rotation, 1.0, 0.15);
  EXPECT_NEAR(found.together, 1.0, 0.11);
}

TEST(VisualConsistency, ErrorsOfTwiceTheSigmaGiveFour) {
  EXPECT_NEAR(of(visual_run(1200, 2.0, 3)).together, 4.0, 0.4);
}

TEST(VisualConsistency, OnlyWholeAlignmentsCount) {
  RunRecord run = visual_run(12, 1.0, 3);
  run.visual[5].lost = true;  // the second keyframe ends before it
  run.visual[8].cov.setConstant(kNaN);
  run.visual.resize(9);  // the third has no covariance
  EXPECT_EQ(of(run).keyframes, 2);
  run.visual.erase(run.visual.begin());  // the first motion of the first is missing
  EXPECT_EQ(of(run).keyframes, 1);
  run.truth.clear();
  EXPECT_EQ(of(run).keyframes, 0);
  EXPECT_TRUE(std::isnan(of(run).together));
}

}  // namespace
}  // namespace rover::report
