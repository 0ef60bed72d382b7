// Slope, roughness, steps and classes on maps of known shape.
#include "tools/orbital_planner/terrain.hpp"

#include <gtest/gtest.h>

#include "map_fixture.hpp"
#include "test/common/randoms.hpp"
#include "tools/orbital_planner/travel_cost.hpp"

namespace rover::orbital {
namespace {

using testing_support::uniform;

size_t at(const TerrainLayers& layers, int x, int y) {
  return static_cast<size_t>(y) * layers.width + x;
}

TEST(Terrain, APlaneHasItsSlopeEverywhereAndNoRoughness) {
  for (double cell_m : {0.5, 1.0, 2.0})
    for (double slope_deg : {0.0, 4.0, 9.0, 14.0}) {
      const double gx = 0.6 * std::tan(to_rad(slope_deg)), gy = 0.8 * std::tan(to_rad(slope_deg));
      const TerrainLayers layers =
          analyse(map_of(20, 15, cell_m, [&](double x, double y) { return gx * x + gy * y; }), {});
      for (int y = 2; y < 13; ++y)
        for (int x = 2; x < 18; ++x) {
          EXPECT_NEAR(to_deg(layers.slope_rad[at(layers, x, y)]), slope_deg, 1e-3);
          EXPECT_NEAR(layers.roughness_m[at(layers, x, y)], 0.0, 1e-4);
          EXPECT_NEAR(layers.step_m[at(layers, x, y)], 0.0, 1e-4);
          EXPECT_NEAR(layers.difficulty[at(layers, x, y)], slope_deg / 15.0, 1e-3);
        }
    }
}

TEST(Terrain, ClassesFollowTheLimits) {
  const auto class_of = [](double slope_deg) {
    const double g = std::tan(to_rad(slope_deg));
    return analyse(map_of(9, 9, 1.0, [g](double x, double) { return g * x; }), {}).terrain_class[4 * 9 + 4];
  };
  EXPECT_EQ(class_of(4.9), TerrainClass::kLevel);
  EXPECT_EQ(class_of(5.1), TerrainClass::kSloping);
  EXPECT_EQ(class_of(10.1), TerrainClass::kSteep);
  EXPECT_EQ(class_of(14.9), TerrainClass::kSteep);
  EXPECT_EQ(class_of(15.1), TerrainClass::kObstacle);
}

TEST(Terrain, RoughnessEqualsNoiseDeviation) {
  std::mt19937_64 random(3);
  const TerrainLayers layers =
      analyse(map_of(60, 60, 1.0, [&](double, double) { return uniform(random, -0.2, 0.2); }), {});
  double mean = 0.0;
  for (int y = 2; y < 58; ++y)
    for (int x = 2; x < 58; ++x) mean += layers.roughness_m[at(layers, x, y)] / (56.0 * 56.0);
  // The plane fit removes three degrees of freedom from 25 cells.
  EXPECT_NEAR(mean, 0.4 / std::sqrt(12.0) * std::sqrt(22.0 / 25.0), 0.006);
}

TEST(Terrain, ABoulderAndAnEdgeAreObstacles) {
  const TerrainLayers boulder =
      analyse(map_of(21, 21, 1.0, [](double x, double y) { return x == 10.5 && y == 10.5 ? 0.8 : 0.0; }), {});
  EXPECT_EQ(boulder.terrain_class[at(boulder, 10, 10)], TerrainClass::kObstacle);
  EXPECT_EQ(boulder.terrain_class[at(boulder, 4, 4)], TerrainClass::kLevel);
  const TerrainLayers edge = analyse(map_of(21, 21, 1.0, [](double x, double) { return x > 10.0 ? 0.8 : 0.0; }), {});
  for (int y = 0; y < 21; ++y) {
    EXPECT_EQ(edge.terrain_class[at(edge, 9, y)], TerrainClass::kObstacle);
    EXPECT_EQ(edge.terrain_class[at(edge, 10, y)], TerrainClass::kObstacle);
    EXPECT_EQ(edge.terrain_class[at(edge, 3, y)], TerrainClass::kLevel);
  }
}

TEST(Terrain, MergedPixelsKeepTheirPlaneAndTheirLargestStep) {
  const auto boulder = [](double x, double y) { return 0.1 * x + (x == 10.125 && y == 10.375 ? 0.8 : 0.0); };
  const TerrainLayers layers = analyse(map_of(84, 82, 0.25, boulder), {}, 4);
  ASSERT_EQ(layers.width, 21);
  ASSERT_EQ(layers.height, 20);
  EXPECT_DOUBLE_EQ(layers.cell_m, 1.0);
  EXPECT_EQ(layers.terrain_class[at(layers, 10, 10)], TerrainClass::kObstacle);
  EXPECT_EQ(layers.terrain_class[at(layers, 11, 10)], TerrainClass::kSloping);
  EXPECT_NEAR(layers.slope_rad[at(layers, 3, 3)], std::atan(0.1), 1e-4);
  EXPECT_NEAR(layers.step_m[at(layers, 3, 3)], 0.0, 1e-4);
  const auto hole = [](double x, double y) { return x == 10.125 && y == 10.375 ? kVoid : 0.0; };
  const TerrainLayers holed = analyse(map_of(84, 80, 0.25, hole), {}, 4);
  EXPECT_EQ(holed.terrain_class[at(holed, 10, 10)], TerrainClass::kUnknown);
  EXPECT_EQ(holed.terrain_class[at(holed, 11, 10)], TerrainClass::kLevel);
}

TEST(Terrain, CellsWithoutHeightAreUnknownAndIgnoredByNeighbours) {
  const double g = std::tan(to_rad(8.0));
  const TerrainLayers layers =
      analyse(map_of(21, 21, 1.0, [g](double x, double y) { return x == 10.5 && y == 10.5 ? kVoid : g * x; }), {});
  EXPECT_EQ(layers.terrain_class[at(layers, 10, 10)], TerrainClass::kUnknown);
  EXPECT_TRUE(std::isnan(layers.difficulty[at(layers, 10, 10)]));
  EXPECT_EQ(layers.terrain_class[at(layers, 9, 10)], TerrainClass::kSloping);
  EXPECT_NEAR(to_deg(layers.slope_rad[at(layers, 9, 10)]), 8.0, 1e-3);
}

TEST(Terrain, TooFewHeightsMakeCellUnknown) {
  // Only every third column has heights: less than half of each square.
  const TerrainLayers layers =
      analyse(map_of(21, 21, 1.0, [](double x, double) { return static_cast<int>(x) % 3 == 0 ? 1.0F : kVoid; }), {});
  for (TerrainClass c : layers.terrain_class) EXPECT_EQ(c, TerrainClass::kUnknown);
  EXPECT_NEAR(class_fractions(layers)[0], 1.0, 1e-9);
}

TEST(TravelCost, FollowsSlopeCostTable) {
  EXPECT_DOUBLE_EQ(slope_cost(0.0), 1.0);
  EXPECT_NEAR(slope_cost(to_rad(2.5)), 1.25, 1e-12);
  EXPECT_NEAR(slope_cost(to_rad(5.0)), 1.5, 1e-12);
  EXPECT_NEAR(slope_cost(to_rad(10.0)), 2.5, 1e-12);
  EXPECT_NEAR(slope_cost(to_rad(15.0)), 4.0, 1e-12);
  EXPECT_NEAR(slope_cost(to_rad(20.0)), 5.5, 1e-12);
}

TEST(TravelCost, KeepsClearanceFromVoidsAndBorder) {
  TerrainConfig whole;
  whole.min_known_fraction = 0.3;  // in a corner a third of the square is within the map
  const TerrainLayers layers =
      analyse(map_of(41, 41, 1.0, [](double x, double y) { return x == 20.5 && y == 20.5 ? kVoid : 0.0F; }), whole);
  const CostConfig config{3.0, 6.0, 1.0, 1.0};
  const CostMap map = travel_cost(layers, config);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      const double distance = std::min({std::hypot(x - 20, y - 20), x + 1.0, y + 1.0, 41.0 - x, 41.0 - y});
      const double cost = map.grid.cost_per_m[at(layers, x, y)];
      EXPECT_NEAR(map.obstacle_distance_m[at(layers, x, y)], distance, 1e-9);
      if (distance < 3.0)
        EXPECT_EQ(cost, kInfinity) << x << " " << y;
      else
        EXPECT_NEAR(cost, 1.0 + std::max(0.0, (6.0 - distance) / 3.0), 1e-9) << x << " " << y;
    }
}

}  // namespace
}  // namespace rover::orbital
