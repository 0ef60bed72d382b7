// Noisy elevation maps of the simulator's rock fields.
#include <gtest/gtest.h>

#include "rover_simulator/world/world.hpp"
#include "test/traversability/synthetic_terrain.hpp"
#include "traversability/difficulty.hpp"

namespace rover::trav {
namespace {

using namespace testing_support;

constexpr double kSideM = 120.0;

// Sloping ground with rock abundance k.
World make_world(double k, double slope_deg, std::uint64_t seed) {
  WorldConfig config;
  config.rocks.k = k;
  return World(config, plane_raster(kSideM, kSideM, 1.0, to_rad(slope_deg), 0.0), seed);
}

TerrainGrid map_of(const World& world, double x_m, double y_m, std::uint64_t seed) {
  SyntheticMap spec;
  spec.center_x_m = x_m;
  spec.center_y_m = y_m;
  spec.noise_m = spec.sigma_m = 0.012;
  return synthetic_terrain([&](double x, double y) { return world.height_m(x, y); }, spec, seed);
}

struct RockCells {
  int all = 0, passable = 0;
};

// Sample points on rocks of at least this height.
RockCells cells_on_rocks(const World& world, const TraversabilityMap& map, double min_height_m) {
  RockCells out;
  const double x0 = map.shape.origin_x_m, y0 = map.shape.origin_y_m;
  for (double y = y0 + 0.025; y < y0 + 20.0; y += 0.05)
    for (double x = x0 + 0.025; x < x0 + 20.0; x += 0.05) {
      if (world.height_m(x, y) - world.ground_height_m(x, y) < min_height_m) continue;
      const int ix = static_cast<int>((x - x0) / map.shape.cell_m), iy = static_cast<int>((y - y0) / map.shape.cell_m);
      ++out.all;
      out.passable += map.cells[map.shape.at(ix, iy)] < kLow;
    }
  return out;
}

TEST(RockField, NoCellOnTwentyCentimetreRockIsPassable) {
  for (double slope : {0.0, 10.0}) {
    const World world = make_world(0.12, slope, 3);
    for (int k = 0; k < 3; ++k) {
      const double x = 20.0 + 30.0 * k;
      const TraversabilityMap map =
          compute_traversability(map_of(world, x, 60.0, 7 + static_cast<std::uint64_t>(k)), {});
      const RockCells places = cells_on_rocks(world, map, 0.20);
      EXPECT_GT(places.all, 500);
      EXPECT_EQ(places.passable, 0) << "of " << places.all << " at " << slope << " deg, map " << k;
    }
  }
}

TEST(RockField, EveryTwentyCentimetreRockIsDetected) {
  const World world = make_world(0.12, 5.0, 4);
  int rocks = 0, found = 0, low = 0, low_found = 0;
  for (double x : {20.0, 45.0, 70.0, 95.0}) {
    const TraversabilityMap map = compute_traversability(map_of(world, x, 40.0, 5), {});
    for (const Rock& rock : world.rocks_in(x - 9.0, 31.0, x + 9.0, 49.0)) {
      const double reach = 0.5 * rock.diameter_m;
      const bool hit = count(map, [&](double px, double py) {
                         return std::hypot(px - rock.x_m, py - rock.y_m) <= reach;
                       }).impassable > 0;
      if (rock.height_m >= 0.20) {
        ++rocks;
        found += hit;
      } else if (rock.height_m >= 0.15) {
        ++low;
        low_found += hit;
      }
    }
  }
  EXPECT_GT(rocks, 100);
  EXPECT_EQ(found, rocks);
  EXPECT_GT(low, 100);
  EXPECT_GE(low_found, 0.9 * low) << low_found << " of " << low;
}

TEST(RockField, BareGroundHasNoObstacles) {
  for (double slope : {0.0, 6.0, 12.0}) {
    const World world = make_world(0.0, slope, 6);
    EXPECT_EQ(count_all(compute_traversability(map_of(world, 60.0, 60.0, 3), {})).impassable, 0) << slope;
  }
}

// Mean over several positions and headings.
double mean_difficulty(double k, double slope_deg) {
  const World world = make_world(k, slope_deg, 8);
  double sum = 0.0;
  int n = 0;
  for (double x : {15.0, 35.0, 55.0, 75.0, 95.0}) {
    const TraversabilityMap map = compute_traversability(map_of(world, x, 50.0, 2), {});
    for (double yaw : {0.0, 0.8, 2.0, -1.5}) {
      const double now = difficulty_ahead(map, {x, 50.0, yaw}, {});
      sum += now;
      ++n;
    }
  }
  return sum / n;
}

TEST(RockField, DifficultySeparatesEasyFromHardGround) {
  constexpr double kEasy = 0.25;  // config/supervisor.yaml
  EXPECT_LT(mean_difficulty(0.02, 3.0), 0.5 * kEasy);
  EXPECT_LT(mean_difficulty(0.03, 0.0), 0.7 * kEasy);
  EXPECT_LT(mean_difficulty(0.03, 5.0), 0.7 * kEasy);
  EXPECT_GT(mean_difficulty(0.12, 0.0), 1.5 * kEasy);
  EXPECT_GT(mean_difficulty(0.02, 14.0), 1.5 * kEasy);
}

}  // namespace
}  // namespace rover::trav
