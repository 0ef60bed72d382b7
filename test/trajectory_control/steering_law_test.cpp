#include "trajectory_control/steering_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rover::control {
namespace {

const SteeringLawConfig kConfig;

TEST(SteeringLaw, WithoutErrorItReturnsThePathCurvature) {
  for (const double k : {-0.8, 0.0, 0.3}) EXPECT_DOUBLE_EQ(steering_law(kConfig, k, {0.0, 0.0}, 0.0), k);
}

TEST(SteeringLaw, SteersTowardsThePathSymmetrically) {
  EXPECT_LT(steering_law(kConfig, 0.0, {0.1, 0.0}, 0.0), 0.0);
  EXPECT_LT(steering_law(kConfig, 0.0, {0.0, 0.1}, 0.0), 0.0);
  for (const double e : {0.02, 0.2, 1.0})
    for (const double h : {-0.3, 0.1, 0.4})
      EXPECT_DOUBLE_EQ(steering_law(kConfig, 0.2, {e, h}, 0.05), -steering_law(kConfig, -0.2, {-e, -h}, -0.05));
}

TEST(SteeringLaw, StaysWithinTheMinimumRadius) {
  EXPECT_EQ(steering_law(kConfig, 0.9, {-5.0, -1.0}, 0.0), kConfig.max_curvature_per_m);
  EXPECT_EQ(steering_law(kConfig, -0.9, {5.0, 1.0}, 0.0), -kConfig.max_curvature_per_m);
}

TEST(SteeringLaw, FeedforwardFollowsTheConcentricCircle) {
  // 0.1 m inside a circle of 2 m, feedback removed: the concentric circle of 1.9 m.
  const double k = steering_law(kConfig, 0.5, {0.1, 0.0}, 0.0) + 0.1 / (kConfig.length_m * kConfig.length_m);
  EXPECT_NEAR(k, 1.0 / 1.9, 1e-12);
}

TEST(SteeringLaw, ErrorDecaysCriticallyDamped) {
  // Critically damped: e(s) = e0 (1 + s/L) exp(-s/L).
  double e = 0.05;
  double h = 0.0;
  constexpr double ds = 1e-3;
  for (int i = 1; i <= 3000; ++i) {
    h += ds * steering_law(kConfig, 0.0, {e, h}, 0.0);
    e += ds * std::sin(h);
    const double s = i * ds / kConfig.length_m;
    if (i % 500 == 0) {
      EXPECT_NEAR(e, 0.05 * (1.0 + s) * std::exp(-s), 1e-3) << i;
    }
  }
}

}  // namespace
}  // namespace rover::control
