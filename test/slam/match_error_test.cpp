// What SLAM learns of the errors of its matches.
#include "slam/match_error.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rover::slam {
namespace {

const Eigen::Matrix2d kClaimed = Eigen::Matrix2d::Identity() * 1e-4;  // 1 cm

// Matches with this mean error and scatter.
void learn(MatchError& error, const Eigen::Vector2d& mean_m, double sigma_m, int matches, double pose_sigma_m = 0.002) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, sigma_m);
  for (int i = 0; i < matches; ++i) {
    error.predict(0.5);
    const double dx = normal(random), dy = normal(random);
    error.update(mean_m + Eigen::Vector2d(dx, dy), kClaimed, pose_sigma_m);
  }
}

TEST(MatchError, LearnsConstantErrorAndScatter) {
  MatchError error({});
  learn(error, {0.02, -0.01}, 0.025, 200);
  EXPECT_NEAR(error.bias().x_m, 0.02, 0.008);
  EXPECT_NEAR(error.bias().y_m, -0.01, 0.008);
  EXPECT_NEAR(error.scatter(), 6.25, 3.0);
}

TEST(MatchError, MatchesAsSureAsTheyClaimStaySo) {
  MatchError error({});
  learn(error, {0.0, 0.0}, 0.008, 200);
  EXPECT_LT(error.scatter(), 1.5);
}

TEST(MatchError, UncertainPoseTeachesLittle) {
  MatchError error({});
  learn(error, {0.02, 0.0}, 0.0, 10, 0.2);
  EXPECT_LT(std::abs(error.bias().x_m), 0.003);
}

TEST(MatchError, OutliersAndNanTeachNothing) {
  MatchError error({});
  error.update({0.3, 0.0}, kClaimed, 0.002);
  error.update({kNaN, 0.0}, kClaimed, 0.002);
  error.update({0.01, 0.0}, Eigen::Matrix2d::Constant(kNaN), 0.002);
  EXPECT_EQ(error.bias().x_m, 0.0);
  EXPECT_EQ(error.scatter(), 1.0);
}

}  // namespace
}  // namespace rover::slam
