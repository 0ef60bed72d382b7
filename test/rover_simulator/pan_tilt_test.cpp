#include <gtest/gtest.h>

#include "rover_simulator/vehicle/pan_tilt_sim.hpp"

namespace rover {
namespace {

const PanTiltUnit kUnit{.pan_max_rad = 2.0, .tilt_min_rad = -0.3, .tilt_max_rad = 0.8, .rate_radps = 0.5};
constexpr double kTickS = 0.02;

// Ticks until the unit is stationary.
int settle(PanTiltSim& unit) {
  int ticks = 0;
  for (; unit.state().moving && ticks < 1000; ++ticks) unit.advance(kTickS);
  return ticks;
}

TEST(PanTiltSim, MovesAtConstantRateAndRequestsImageOnArrival) {
  PanTiltSim unit(kUnit, 0.0, 1);
  EXPECT_FALSE(unit.image_due());
  unit.command({1.0, 0.2, true});
  EXPECT_TRUE(unit.state().moving);
  unit.advance(kTickS);
  EXPECT_NEAR(unit.state().pan_rad, 0.01, 1e-12);
  EXPECT_NEAR(unit.state().tilt_rad, 0.01, 1e-12);
  EXPECT_FALSE(unit.image_due());
  EXPECT_NEAR(settle(unit), 99, 1);
  EXPECT_DOUBLE_EQ(unit.state().pan_rad, 1.0);
  EXPECT_DOUBLE_EQ(unit.state().tilt_rad, 0.2);
  ASSERT_TRUE(unit.image_due());
  unit.image_taken();
  EXPECT_FALSE(unit.image_due());
}

TEST(PanTiltSim, ClipsToLimitsAndIgnoresNonFiniteCommands) {
  PanTiltSim unit(kUnit, 0.0, 1);
  unit.command({-5.0, 5.0, false});
  settle(unit);
  EXPECT_DOUBLE_EQ(unit.state().pan_rad, -2.0);
  EXPECT_DOUBLE_EQ(unit.state().tilt_rad, 0.8);
  unit.command({std::numeric_limits<double>::quiet_NaN(), 0.0, true});
  unit.command({0.0, std::numeric_limits<double>::infinity(), true});
  EXPECT_FALSE(unit.state().moving);
  EXPECT_FALSE(unit.image_due());
}

TEST(PanTiltSim, NewCommandCancelsPreviousImageRequest) {
  PanTiltSim unit(kUnit, 0.0, 1);
  unit.command({1.0, 0.0, true});
  unit.advance(kTickS);
  unit.command({0.0, 0.0, false});
  settle(unit);
  EXPECT_DOUBLE_EQ(unit.state().pan_rad, 0.0);
  EXPECT_FALSE(unit.image_due());
}

TEST(PanTiltSim, TrueAngleDiffersFromReportedByRepeatability) {
  constexpr double kSigma = 0.001;
  PanTiltSim unit(kUnit, kSigma, 1);
  double squares = 0.0;
  constexpr int kMoves = 400;
  for (int i = 1; i <= kMoves; ++i) {
    unit.command({i % 2 * 0.1, 0.0, false});
    settle(unit);
    const double error = unit.pan_rad() - unit.state().pan_rad;
    EXPECT_NE(error, 0.0);
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / kMoves), kSigma, 0.15 * kSigma);
}

}  // namespace
}  // namespace rover
