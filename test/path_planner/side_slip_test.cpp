#include "path_planner/side_slip.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

constexpr double kTickS = 0.02;
constexpr double kSlide = 0.15;  // metres for each metre, south

// Drives at the heading over a slope that falls to the south.
void drive(SideSlip& slip, double yaw_rad, double forward_mps, double metres) {
  for (double s = 0.0; s < metres; s += std::abs(forward_mps) * kTickS)
    slip.learn(yaw_rad, forward_mps, -kSlide * std::abs(forward_mps) * std::cos(yaw_rad), kTickS);
}

TEST(SideSlip, IsKnownForOtherHeadingsToo) {
  SideSlip slip;
  drive(slip, 0.0, 0.2, 5.0);
  EXPECT_NEAR(slip.at(0.0), -kSlide, 0.002);
  EXPECT_NEAR(slip.at(kPi), kSlide, 0.002);
  EXPECT_NEAR(slip.at(0.5 * kPi), 0.0, 0.002);
}

TEST(SideSlip, IsTheSameInReverse) {
  SideSlip slip;
  drive(slip, 0.0, -0.1, 5.0);
  EXPECT_NEAR(slip.at(0.0), -kSlide, 0.002);
}

TEST(SideSlip, GoesOnLevelGround) {
  SideSlip slip{{0.0, -kSlide}};
  for (int i = 0; i < 2000; ++i) slip.learn(0.0, 0.2, 0.0, kTickS);
  EXPECT_NEAR(slip.at(0.0), 0.0, 0.002);
}

TEST(SideSlip, IsNotLearntAtStandstillAndIsBounded) {
  SideSlip slip;
  slip.learn(0.0, 0.02, 0.02, 100.0);
  EXPECT_EQ(slip.at(0.0), 0.0);
  slip.learn(0.0, 0.04, 4.0, 100.0);
  EXPECT_NEAR(slip.at(0.0), SideSlip::kMax, 1e-9);
}

// With the heading of the body on a path the rover moves along the path.
TEST(SideSlip, TheBodyPointsUphillOfThePath) {
  const SideSlip slip{{0.0, -kSlide}};
  for (const bool reverse : {false, true}) {
    const double yaw_rad = slip.heading(0.0, reverse);
    EXPECT_EQ(yaw_rad > 0.0, !reverse);
    const Pose2 end = slip.advanced({0.0, 0.0, yaw_rad}, reverse ? -1.0 : 1.0, 0.0);
    EXPECT_NEAR(end.y_m, 0.0, 0.005);
  }
}

}  // namespace
}  // namespace rover::planning
