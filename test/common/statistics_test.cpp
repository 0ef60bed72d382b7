#include "common/core/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rover {
namespace {

TEST(Wilson, MatchesPublishedIntervals) {
  // Newcombe 1998, Statistics in Medicine 17, 857-872, table I, method 3.
  const Interval common = wilson(81, 263);
  EXPECT_NEAR(common.low, 0.2553, 5e-5);
  EXPECT_NEAR(common.high, 0.3662, 5e-5);
  const Interval none = wilson(0, 20);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.1611, 5e-5);
  const Interval all = wilson(20, 20);
  EXPECT_NEAR(all.low, 1.0 - none.high, 1e-12);
  EXPECT_EQ(all.high, 1.0);
  EXPECT_TRUE(std::isnan(wilson(0, 0).low));
}

TEST(MeanNeesBounds, MatchChiSquareTables) {
  EXPECT_NEAR(mean_nees_bounds(1).low, 0.000982, 1e-6);
  EXPECT_NEAR(mean_nees_bounds(1).high, 5.0239, 1e-4);
  EXPECT_NEAR(mean_nees_bounds(3).low, 0.2158 / 3.0, 1e-4);
  EXPECT_NEAR(mean_nees_bounds(3).high, 9.3484 / 3.0, 1e-4);
  EXPECT_NEAR(mean_nees_bounds(100).low, 0.74222, 1e-5);
  EXPECT_NEAR(mean_nees_bounds(100).high, 1.29561, 1e-5);
  EXPECT_TRUE(std::isnan(mean_nees_bounds(0).high));
}

TEST(MeanNeesBounds, ContainTheMeanOfConsistentRunsIn95Percent) {
  constexpr int kTrials = 4000, kRuns = 20, kSize = 3;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Interval bounds = mean_nees_bounds(kRuns * kSize);
  int inside = 0;
  for (int i = 0; i < kTrials; ++i) {
    double sum = 0.0;
    for (int k = 0; k < kRuns * kSize; ++k) {
      const double error = normal(random);
      sum += error * error / (kRuns * kSize);
    }
    inside += sum >= bounds.low && sum <= bounds.high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kTrials, 0.95, 0.012);
}

}  // namespace
}  // namespace rover
