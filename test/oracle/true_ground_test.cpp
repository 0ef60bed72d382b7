#include "tools/oracle/true_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rover_simulator/world/world.hpp"

namespace rover::oracle {
namespace {

World rocky_slope(double k) {
  WorldConfig config;
  config.rocks.k = k;
  return {config, plane_raster(40.0, 40.0, 1.0, to_rad(12.0), to_rad(50.0)), 5};
}

HeightFunction surface_of(const World& world) {
  return [&](double x_m, double y_m) { return world.height_m(x_m, y_m); };
}

HeightFunction ground_of(const World& world) {
  return [&](double x_m, double y_m) { return world.ground_height_m(x_m, y_m); };
}

TEST(LocalGround, IsTheBareGroundBelowAnyRocks) {
  for (const double k : {0.0, 0.20}) {
    const World world = rocky_slope(k);
    LocalGround ground(ground_of(world));
    double sum = 0.0;
    double squares = 0.0;
    int n = 0;
    for (double x = 5.0; x < 35.0; x += 0.37)
      for (double y = 5.0; y < 35.0; y += 0.37, ++n) {
        const double error = ground.at(x, y) - world.smooth_height_m(x, y);
        sum += error;
        squares += error * error;
      }
    EXPECT_NEAR(sum / n, 0.0, 0.006) << k;
    EXPECT_LT(std::sqrt(squares / n), 0.015) << k;
  }
}

TEST(TrueGround, SlopeIsThatBelowTheRocks) {
  const World world = rocky_slope(0.12);
  TrueGround ground(surface_of(world), ground_of(world), {});
  for (double x = 5.0; x < 35.0; x += 1.3)
    for (double y = 5.0; y < 35.0; y += 1.3) EXPECT_NEAR(to_deg(ground.slope_rad(x, y)), 12.0, 2.0);
}

TEST(TrueGround, TallRocksAreHazardsAndLowOnesAreNot) {
  const World world = rocky_slope(0.08);
  TrueGround ground(surface_of(world), ground_of(world), {});
  int tall = 0;
  int found = 0;
  for (const Rock& rock : world.rocks_in(6.0, 6.0, 34.0, 34.0)) {
    if (rock.height_m < 0.17) continue;
    ++tall;
    bool near = false;
    for (int bx = ground.block_index(rock.x_m) - 1; bx <= ground.block_index(rock.x_m) + 1; ++bx)
      for (int by = ground.block_index(rock.y_m) - 1; by <= ground.block_index(rock.y_m) + 1; ++by)
        for (const Hazard& hazard : ground.hazards(bx, by))
          near |= std::hypot(hazard.x_m - rock.x_m, hazard.y_m - rock.y_m) < 0.5 * rock.diameter_m;
    found += near ? 1 : 0;
  }
  EXPECT_GT(tall, 50);
  EXPECT_GE(found, 0.99 * tall);
  int without_rock = 0;
  for (int bx = ground.block_index(6.0); bx < ground.block_index(34.0); ++bx)
    for (int by = ground.block_index(6.0); by < ground.block_index(34.0); ++by)
      for (const Hazard& hazard : ground.hazards(bx, by))
        without_rock += world.material(hazard.x_m, hazard.y_m).rock_height_m < 0.09 ? 1 : 0;
  EXPECT_EQ(without_rock, 0);
}

}  // namespace
}  // namespace rover::oracle
