#include "@NAME@/@NAME@.hpp"

#include <gtest/gtest.h>

namespace rover::@NAME@ {
namespace {

TEST(@CLASS@Test, StraightLineAndWayBackBothCount) {
  @CLASS@ core({});
  EXPECT_EQ(core.step({1.0, 2.0, 0.0}), 0.0) << "the first position is the start";
  EXPECT_NEAR(core.step({1.0, 5.0, 0.0}), 3.0, 1e-12);
  EXPECT_NEAR(core.step({1.0, 2.0, 0.0}), 6.0, 1e-12);
}

TEST(@CLASS@Test, VibrationDoesNotCountSlowMotionDoes) {
  @CLASS@ core({.min_step_m = 0.02});
  core.step(Eigen::Vector3d::Zero());
  for (int i = 0; i < 100; ++i) EXPECT_EQ(core.step({0.0, 0.0, i % 2 == 0 ? 0.005 : -0.005}), 0.0);
  double distance_m = 0.0;
  for (int i = 1; i <= 1000; ++i) distance_m = core.step({0.001 * i, 0.0, 0.0});
  EXPECT_NEAR(distance_m, 1.0, 0.02);
}

}  // namespace
}  // namespace rover::@NAME@
