// Monte Carlo consistency of the covariance: normalised estimation error squared, NEES (Bar-Shalom, Li & Kirubarajan,
// 2001, ch. 5.4).
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "synthetic_drive.hpp"

namespace rover::loc {
namespace {

constexpr int kRuns = 40;
constexpr double kStartSigma = 0.1;
constexpr double kStartSigmaYaw = 0.01;

struct Outcome {
  double planar_nees = 0.0;  // x, y, yaw in map
  double tilt_nees = 0.0;    // roll, pitch
};

Outcome run_once(std::uint64_t seed) {
  DriveNoise noise;
  noise.visual_scale = LocalizationConfig{}.filter.visual_scale_sigma;
  noise.mounting_rad = LocalizationConfig{}.filter.mounting_sigma_rad;
  SyntheticDrive drive({}, seed, noise);
  drive.command = [](double t) { return t < 1.5 ? Twist{} : Twist{0.2, 0.06 * std::sin(0.1 * t)}; };
  std::mt19937_64 random(seed * 7919);
  std::normal_distribution<double> normal;
  drive.run(1.5);
  // The start pose errs by its stated sigma.
  const Pose2 start_error{kStartSigma * normal(random), kStartSigma * normal(random), kStartSigmaYaw * normal(random)};
  drive.localization.set_start_pose(
      {{start_error.x_m, start_error.y_m, 0.0}, start_error.yaw_rad, kStartSigma, kStartSigmaYaw});
  drive.run(100.0);
  const PoseEstimate& pose = drive.localization.pose();
  const Eigen::Isometry3d T = pose.T_map_odom * pose.T_odom_body;
  const Eigen::Isometry3d truth = drive.truth_odom();
  const Eigen::Vector3d turn = log_so3(truth.linear() * T.linear().transpose());
  const Eigen::Vector3d planar(truth.translation().x() - T.translation().x(),
                               truth.translation().y() - T.translation().y(), turn.z());
  Eigen::Matrix3d P;
  const std::array<int, 3> rows = {0, 1, 5};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) P(i, j) = pose.cov(rows[static_cast<size_t>(i)], rows[static_cast<size_t>(j)]);
  const Eigen::Matrix2d L = pose.cov.block<2, 2>(3, 3);
  return {planar.dot(P.inverse() * planar), turn.head<2>().dot(L.inverse() * turn.head<2>())};
}

TEST(Consistency, MeanNeesWithinBounds) {
  double planar = 0.0;
  double tilt = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    const Outcome outcome = run_once(static_cast<std::uint64_t>(100 + i));
    planar += outcome.planar_nees / kRuns;
    tilt += outcome.tilt_nees / kRuns;
  }
  RecordProperty("planar_nees", std::to_string(planar));
  std::cout << "mean NEES planar " << planar << " of 3, tilt " << tilt << " of 2\n";
  // Mean of 40 chi-square values with 3 degrees of freedom: 99.9 % within 1.8 .. 4.5. The filter's noise parameters
  // are conservative, so the lower bound is wider.
  EXPECT_GT(planar, 1.0);
  EXPECT_LT(planar, 4.5);
  EXPECT_LT(tilt, 4.0);
}

}  // namespace
}  // namespace rover::loc
