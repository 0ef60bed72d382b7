// Where the body will be on its way along a route.
#include "path_planner/expected_motion.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

const Route kEast{{{{0.0, 0.0}, kNaN, 0}, {{10.0, 0.0}, kNaN, 0}}};

TEST(ExpectedMotion, BeginsAtTheRoverAndEndsOnTheRoute) {
  const Pose2 rover{2.0, 0.1, 0.2};
  const ExpectedMotion motion(kEast, 2.0, rover, {}, false);
  EXPECT_NEAR(motion.at(2.0).y_m, rover.y_m, 1e-9);
  EXPECT_NEAR(motion.at(2.0).yaw_rad, rover.yaw_rad, 1e-9);
  double before_m = rover.y_m;
  for (double s = 2.1; s < 3.0; s += 0.1) {
    EXPECT_LT(motion.at(s).y_m, before_m);
    before_m = motion.at(s).y_m;
  }
  EXPECT_NEAR(motion.at(3.5).y_m, 0.0, 1e-9);
  EXPECT_NEAR(motion.at(3.5).yaw_rad, 0.0, 1e-9);
}

TEST(ExpectedMotion, BehindTheRoverTheErrorIsThatOfNow) {
  const ExpectedMotion motion(kEast, 2.0, {2.0, 0.1, 0.0}, {}, false);
  EXPECT_NEAR(motion.at(1.5).y_m, 0.1, 1e-9);
  EXPECT_NEAR(motion.at(1.5).x_m, 1.5, 1e-9);
}

TEST(ExpectedMotion, ATurningRoverKeepsNoHeadingError) {
  const ExpectedMotion motion(kEast, 2.0, {2.0, 0.1, 1.2}, {}, true);
  EXPECT_NEAR(motion.at(2.0).yaw_rad, 0.0, 1e-9);
  EXPECT_NEAR(motion.at(2.0).y_m, 0.1, 1e-9);
}

// A slope that falls to the south.
TEST(ExpectedMotion, OnASideSlopeTheBodyPointsUphill) {
  const SideSlip slip{{0.0, -0.15}};
  const Pose2 rover{2.0, 0.0, slip.heading(0.0, false)};
  ASSERT_GT(rover.yaw_rad, 0.1);
  const ExpectedMotion motion(kEast, 2.0, rover, slip, false);
  for (double s = 2.0; s < 4.0; s += 0.5) EXPECT_NEAR(motion.at(s).yaw_rad, rover.yaw_rad, 1e-9);
}

}  // namespace
}  // namespace rover::planning
