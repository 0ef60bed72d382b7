#include "tools/report/wheel_clearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "known_run.hpp"

namespace rover::report {
namespace {

// Cylinders on flat ground.
TrueWorld world_of(const std::vector<Rock>& rocks) {
  TrueWorld world{rocks, {}, {}};
  world.ground_m = [](double, double) { return 0.0; };
  world.height_m = [rocks](double x, double y) {
    double height = 0.0;
    for (const Rock& rock : rocks)
      if (std::hypot(x - rock.x_m, y - rock.y_m) <= rock.radius_m) height = std::max(height, rock.height_m);
    return height;
  };
  return world;
}

double clearance(const RunRecord& run, const std::vector<Rock>& rocks) {
  return figures(run, world_of(rocks)).hazard_clearance_m;
}

// The left wheels roll along y = 0.41, 0.12 m wide.
TEST(WheelClearance, IsFromTheWheelsSideToTheRock) {
  EXPECT_NEAR(clearance(straight_run(10.0), {{5.0, 1.0, 0.2, 0.3}}), 1.0 - 0.2 - 0.47, 0.02);
  EXPECT_EQ(clearance(straight_run(10.0), {{5.0, 0.5, 0.1, 0.3}}), 0.0);
}

TEST(WheelClearance, StraddledRockIsBetweenTheWheels) {
  EXPECT_NEAR(clearance(straight_run(10.0), {{5.0, 0.0, 0.2, 0.16}}), 0.41 - 0.06 - 0.2, 0.02);
}

TEST(WheelClearance, LowRocksAndLowFlanksAreNoHazards) {
  EXPECT_TRUE(std::isnan(clearance(straight_run(10.0), {{5.0, 0.41, 0.2, 0.14}})));
  // A cone of 0.3 m: the part above 0.15 m has half its radius.
  TrueWorld cone = world_of({{5.0, 1.0, 0.4, 0.3}});
  cone.height_m = [](double x, double y) { return std::max(0.0, 0.3 * (1.0 - std::hypot(x - 5.0, y - 1.0) / 0.4)); };
  EXPECT_NEAR(figures(straight_run(10.0), cone).hazard_clearance_m, 1.0 - 0.2 - 0.47, 0.02);
}

TEST(WheelClearance, SteeredWheelsReachFarther) {
  RunRecord run = straight_run(10.0);
  for (const TruthSample& truth : run.truth) {
    WheelSample sample;
    sample.t_s = truth.t_s;
    sample.steer_rad = {M_PI / 2, M_PI / 2, 0.0, 0.0};
    run.wheels.push_back(sample);
  }
  EXPECT_NEAR(clearance(run, {{5.0, 1.0, 0.2, 0.3}}), 1.0 - 0.2 - 0.41 - 0.125, 0.02);
}

// Rolled by 15 deg to the right, the contact points are to the left of where they were.
TEST(WheelClearance, RollMovesTheWheelsSideways) {
  RunRecord run = straight_run(10.0);
  for (TruthSample& truth : run.truth) truth.T_map_body.linear() = rotation_from_rpy(to_rad(15.0), 0.0, 0.0);
  const double left_m = 0.41 * std::cos(to_rad(15.0)) + 0.62 * std::sin(to_rad(15.0)) + 0.06;
  EXPECT_NEAR(clearance(run, {{5.0, 1.0, 0.2, 0.3}}), 1.0 - 0.2 - left_m, 0.02);
}

TEST(WheelClearance, UnknownSurfaceHasNone) {
  EXPECT_TRUE(std::isnan(figures(straight_run(10.0), TrueWorld{{{5.0, 0.5, 0.1, 0.3}}, {}, {}}).hazard_clearance_m));
}

}  // namespace
}  // namespace rover::report
