// Monte Carlo consistency of the covariance: normalised estimation error squared, NEES (Bar-Shalom, Li & Kirubarajan,
// 2001, ch. 5.4).
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "synthetic_drive.hpp"

namespace rover::loc {
namespace {

constexpr int kRuns = 40;
// What the start pose errs by.
struct StartSigma {
  double position_m;
  double yaw_rad;
};

struct Outcome {
  double planar_nees = 0.0;  // x, y, yaw in map
  double tilt_nees = 0.0;    // roll, pitch
};

Outcome run_once(std::uint64_t seed, const StartSigma& sigma) {
  DriveNoise noise;
  noise.visual_scale = LocalizationConfig{}.filter.visual_scale_sigma;
  noise.mounting_rad = LocalizationConfig{}.filter.mounting_sigma_rad;
  SyntheticDrive drive({}, seed, noise);
  drive.command = [](double t) { return t < 1.5 ? Twist{} : Twist{0.2, 0.06 * std::sin(0.1 * t)}; };
  std::mt19937_64 random(seed * 7919);
  std::normal_distribution<double> normal;
  drive.run(1.5);
  // The start pose errs by its stated sigma.
  const Pose2 start_error{sigma.position_m * normal(random), sigma.position_m * normal(random),
                          sigma.yaw_rad * normal(random)};
  drive.localization.set_start_pose(
      {{start_error.x_m, start_error.y_m, 0.0}, start_error.yaw_rad, sigma.position_m, sigma.yaw_rad});
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

Outcome mean_of_runs(const StartSigma& sigma) {
  Outcome mean;
  for (int i = 0; i < kRuns; ++i) {
    const Outcome outcome = run_once(static_cast<std::uint64_t>(100 + i), sigma);
    mean.planar_nees += outcome.planar_nees / kRuns;
    mean.tilt_nees += outcome.tilt_nees / kRuns;
  }
  std::cout << "mean NEES planar " << mean.planar_nees << " of 3, tilt " << mean.tilt_nees << " of 2\n";
  return mean;
}

TEST(Consistency, MeanNeesWithinBounds) {
  const auto [planar, tilt] = mean_of_runs({0.1, 0.01});
  // Mean of 40 chi-square values with 3 degrees of freedom: 99.9 % within 1.8 .. 4.5. The filter's noise parameters
  // are conservative, so the lower bound is wider.
  EXPECT_GT(planar, 1.0);
  EXPECT_LT(planar, 4.5);
  EXPECT_LT(tilt, 4.0);
}

// Of what was driven: next to a start error of 0.1 m the drift does not show.
TEST(Consistency, MeanNeesOfTheDriftWithinBounds) {
  const double planar = mean_of_runs({0.001, 5e-5}).planar_nees;
  EXPECT_GT(planar, 1.0);
  EXPECT_LT(planar, 4.5);
}

}  // namespace
}  // namespace rover::loc
