// Classes and costs on analytic ground.
#include "traversability/traversability.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/core/frames.hpp"
#include "test/traversability/synthetic_terrain.hpp"

namespace rover::trav {
namespace {

using namespace testing_support;

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

TraversabilityMap traversability_of(const TerrainGrid& grid) {
  return compute_traversability(grid, {});
}

bool inner(double x, double y) {
  return std::abs(x) < 8.0 && std::abs(y) < 8.0;
}

double mean_cost(const TraversabilityMap& map) {
  double sum = 0.0;
  int n = 0;
  for (int iy = 0; iy < map.shape.cells_y; ++iy)
    for (int ix = 0; ix < map.shape.cells_x; ++ix)
      if (inner(map.shape.x_m(ix), map.shape.y_m(iy))) {
        sum += map.cells[map.shape.at(ix, iy)];
        ++n;
      }
  return sum / n;
}

TerrainGrid plane(double slope_deg, double azimuth_deg, double noise_m = 0.0, double sigma_m = 0.01) {
  const double g = std::tan(to_rad(slope_deg));
  const double gx = g * std::cos(to_rad(azimuth_deg)), gy = g * std::sin(to_rad(azimuth_deg));
  SyntheticMap spec;
  spec.noise_m = noise_m;
  spec.sigma_m = sigma_m;
  return synthetic_terrain([&](double x, double y) { return 100.0 + gx * x + gy * y; }, spec);
}

TEST(Slopes, CostMatchesPaperUpToLimit) {
  // Paper: cost 10/15/25/40 at 0/5/10/15 deg; here relative to flat ground, scaled to 253 at 19 deg.
  const double paper[] = {0.0, 5.0, 15.0, 30.0};
  for (int k = 0; k <= 3; ++k)
    for (double azimuth : {0.0, 30.0, 90.0, 225.0}) {
      const TraversabilityMap map = traversability_of(plane(5.0 * k, azimuth));
      EXPECT_EQ(count_all(map).passable, 40000) << 5 * k << " deg at " << azimuth;
      EXPECT_NEAR(mean_cost(map), paper[k] * 253.0 / 45.0, 6.0) << 5 * k << " deg at " << azimuth;
    }
}

TEST(Slopes, ImpassableBeyondSlopeLimit) {
  for (double azimuth : {0.0, 45.0, 160.0}) {
    EXPECT_EQ(count_all(traversability_of(plane(18.0, azimuth))).passable, 40000);
    EXPECT_EQ(count_all(traversability_of(plane(20.0, azimuth))).impassable, 40000);
    EXPECT_EQ(count_all(traversability_of(plane(35.0, azimuth))).passable, 0);
  }
}

TEST(Slopes, NoiseWithinSigmaAddsNoObstacleAndLittleCost) {
  for (double slope : {0.0, 8.0, 15.0}) {
    const TraversabilityMap map = traversability_of(plane(slope, 70.0, 0.015, 0.015));
    EXPECT_EQ(count_all(map).passable, 40000) << slope;
    EXPECT_NEAR(mean_cost(map), mean_cost(traversability_of(plane(slope, 70.0))), 15.0) << slope;
  }
}

TEST(Slopes, AreNoSteps) {
  const TerrainGrid slope = plane(16.0, 70.0, 0.01);
  const TraversabilityMap map = traversability_of(slope);
  EXPECT_GT(mean_cost(map), 150.0);
  EXPECT_LT(*std::max_element(map.step_percent.begin(), map.step_percent.end()), 60);
  EXPECT_EQ(map.height_m, slope.height_m);
  const TraversabilityMap block = traversability_of(
      synthetic_terrain([](double x, double y) { return testing_support::block_m(x, y, 0.06, 0.25); }));
  const double limit_m = TraversabilityConfig{}.step_limit_m();
  EXPECT_NEAR(*std::max_element(block.step_percent.begin(), block.step_percent.end()), 100.0 * 0.06 / limit_m, 3.0);
}

class Rocks : public testing::Test {
 protected:
  // A cylinder in the middle of gently sloping ground.
  static TraversabilityMap map_with_block(double height_m, double radius_m, double noise_m, std::uint64_t seed) {
    SyntheticMap spec;
    spec.cells = 60;
    spec.noise_m = noise_m;
    spec.sigma_m = noise_m;
    const double x0 = 0.013 * static_cast<double>(seed % 8), y0 = 0.021 * static_cast<double>(seed % 5);
    return traversability_of(synthetic_terrain(
        [&](double x, double y) { return 0.1 * x - 0.05 * y + block_m(x - x0, y - y0, height_m, radius_m); }, spec,
        seed));
  }
  static Count near(const TraversabilityMap& map, double distance_m) {
    return count(map, [&](double x, double y) { return std::hypot(x, y) < distance_m; });
  }
};

TEST_F(Rocks, ImpassableFromHazardHeight) {
  for (double height : {0.15, 0.20, 0.30})
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const TraversabilityMap map = map_with_block(height, 0.5 * height + 0.05, 0.01, seed);
      EXPECT_GT(near(map, 0.5 * height).impassable, 0) << height << " seed " << seed;
    }
}

TEST_F(Rocks, ThoseOfFifteenCentimetresAreLowAndThoseOfTwentyAreNot) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TraversabilityMap low = map_with_block(0.15, 0.2, 0.005, seed);
    const TraversabilityMap tall = map_with_block(0.20, 0.2, 0.005, seed);
    EXPECT_EQ(std::count(low.cells.begin(), low.cells.end(), kImpassable), 0) << seed;
    EXPECT_GT(std::count(low.cells.begin(), low.cells.end(), kLow), 4) << seed;
    EXPECT_EQ(std::count(tall.cells.begin(), tall.cells.end(), kLow), 0) << seed;
  }
}

TEST_F(Rocks, NoCellPassableFromTwentyCentimetres) {
  for (double height : {0.20, 0.30, 0.6})
    for (double radius : {0.12, 0.25, 0.5, 0.8})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const TraversabilityMap map = map_with_block(height, radius, 0.01, seed);
        const double x0 = 0.013 * static_cast<double>(seed % 8), y0 = 0.021 * static_cast<double>(seed % 5);
        const Count on = count(map, [&](double x, double y) { return std::hypot(x - x0, y - y0) <= radius; });
        EXPECT_EQ(on.passable, 0) << height << " m of radius " << radius << " seed " << seed;
      }
}

TEST_F(Rocks, TenCentimetreRockIsCostlyButPassable) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const TraversabilityMap map = map_with_block(0.10, 0.15, 0.005, seed);
    EXPECT_EQ(count_all(map).impassable, 0) << seed;
    int highest_cost = 0;
    for (int iy = 25; iy < 35; ++iy)
      for (int ix = 25; ix < 35; ++ix) highest_cost = std::max<int>(highest_cost, map.cells[map.shape.at(ix, iy)]);
    EXPECT_GT(highest_cost, 80) << seed;
  }
}

TEST_F(Rocks, TopIsObstacleWhenFarSideIsUnseen) {
  TerrainGrid grid = synthetic_terrain([](double x, double y) { return block_m(x, y, 0.3, 0.6); }, {.cells = 60});
  for (int iy = 0; iy < 60; ++iy)
    for (int ix = 30; ix < 60; ++ix)
      if (std::abs(iy - 30) < 8) grid.height_m[grid.shape.at(ix, iy)] = kUnseen;
  const TraversabilityMap map = traversability_of(grid);
  const Count top = count(map, [](double x, double y) { return x < 0.0 && std::hypot(x, y) < 0.6; });
  EXPECT_EQ(top.passable, 0);
  EXPECT_GT(top.impassable, 40);
}

TEST_F(Rocks, GroundBesideRockStaysPassable) {
  for (double height : {0.2, 0.3, 0.6}) {
    const TraversabilityMap map = map_with_block(height, 0.3, 0.005, 3);
    const Count around = count(map, [](double x, double y) {
      const double r = std::hypot(x - 0.039, y - 0.063);
      return r > 0.3 + 0.15 && r < 1.5;
    });
    EXPECT_EQ(around.impassable, 0) << height;
    EXPECT_EQ(around.unknown, 0) << height;
  }
}

TEST(Ledges, EdgeIsImpassableButGroundAboveAndBelowIsNot) {
  const TraversabilityMap map =
      traversability_of(synthetic_terrain([](double x, double) { return x > 0.0 ? 0.25 : 0.0; }));
  for (int iy = 0; iy < 200; ++iy) {
    EXPECT_EQ(map.cells[map.shape.at(100, iy)], kImpassable);
    EXPECT_LT(map.cells[map.shape.at(99, iy)], kImpassable);
  }
  EXPECT_EQ(count(map, [](double x, double) { return x > 0.3 || x < 0.0; }).impassable, 0);
}

TEST(Ledges, NarrowDitchIsImpassable) {
  const auto ditch = [](double x, double y) { return std::abs(x) < 0.3 && std::abs(y) < 1.2 ? -0.3 : 0.0; };
  const TraversabilityMap map = traversability_of(synthetic_terrain(ditch));
  EXPECT_EQ(count(map, [](double x, double y) { return std::abs(x) < 0.3 && std::abs(y) < 1.2; }).passable, 0);
  EXPECT_EQ(count(map, [](double x, double y) { return std::abs(x) > 0.55 || std::abs(y) > 1.45; }).impassable, 0);
}

TEST(Belly, ConeHigherThanBellyClearanceIsImpassable) {
  // Slope 27 deg: no mean slope over the disc, no step within a wheel diameter.
  const TerrainGrid cone =
      synthetic_terrain([](double x, double y) { return 0.5 * std::max(0.0, 0.9 - std::hypot(x, y)); });
  const auto top = [](double x, double y) { return std::hypot(x, y) < 0.2; };
  TraversabilityConfig config;
  EXPECT_GT(count(compute_traversability(cone, config), top).impassable, 0);
  config.belly_clearance_m = 1.0;
  EXPECT_EQ(count(compute_traversability(cone, config), top).impassable, 0);
}

class Unknown : public testing::Test {
 protected:
  void unsee(int ix, int iy) { flat_.height_m[flat_.shape.at(ix, iy)] = kUnseen; }
  std::uint8_t cell(int ix, int iy) const { return traversability_of(flat_).cells[flat_.shape.at(ix, iy)]; }

  TerrainGrid flat_ = plane(0.0, 0.0);
};

TEST_F(Unknown, UnseenCellsAreUnknown) {
  for (int iy = 50; iy < 60; ++iy)
    for (int ix = 50; ix < 70; ++ix) unsee(ix, iy);
  const TraversabilityMap map = traversability_of(flat_);
  EXPECT_EQ(count_all(map).unknown, 200);
  EXPECT_EQ(count_all(map).impassable, 0);
}

TEST_F(Unknown, HolesUpToTwoCellsInEvenGroundAreFilled) {
  unsee(50, 50);
  unsee(80, 80);
  unsee(81, 81);
  for (int ix : {120, 121, 122}) unsee(ix, 120);
  unsee(0, 30);
  EXPECT_LT(cell(50, 50), kImpassable);
  EXPECT_LT(cell(80, 80), kImpassable);
  EXPECT_LT(cell(81, 81), kImpassable);
  for (int ix : {120, 121, 122}) EXPECT_EQ(cell(ix, 120), kUnknown);
  EXPECT_EQ(cell(0, 30), kUnknown) << "at the border of the map";
}

TEST_F(Unknown, OcclusionShadowOfRockIsNotFilled) {
  flat_.height_m[flat_.shape.at(50, 50)] += 0.25F;
  unsee(51, 50);
  EXPECT_EQ(cell(51, 50), kUnknown);
}

TEST_F(Unknown, HeightsWithInvalidOrLargeSigmaAreUnknown) {
  const float bad[] = {kUnseen, 0.2F, std::numeric_limits<float>::infinity(), -0.01F};
  for (int k = 0; k < 4; ++k)
    for (int iy = 50; iy < 55; ++iy)
      for (int ix = 50 + 10 * k; ix < 55 + 10 * k; ++ix) flat_.sigma_m[flat_.shape.at(ix, iy)] = bad[k];
  for (int iy = 100; iy < 105; ++iy)
    for (int ix = 100; ix < 105; ++ix) flat_.height_m[flat_.shape.at(ix, iy)] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(count_all(traversability_of(flat_)).unknown, 125);
}

TEST_F(Unknown, StepWithinNoiseIsUnknown) {
  for (float sigma : {0.005F, 0.055F}) {
    TerrainGrid grid = flat_;
    const std::size_t i = grid.shape.at(60, 60);
    grid.height_m[i] += 0.2F;
    for (int iy = 55; iy < 66; ++iy)
      for (int ix = 55; ix < 66; ++ix) grid.sigma_m[grid.shape.at(ix, iy)] = sigma;
    EXPECT_EQ(traversability_of(grid).cells[i], sigma < 0.01F ? kImpassable : kUnknown);
  }
}

TEST_F(Unknown, IsolatedCellsAreUnknown) {
  for (int iy = 0; iy < 200; ++iy)
    for (int ix = 0; ix < 200; ++ix)
      if (std::abs(ix - 100) > 1 || std::abs(iy - 100) > 1) unsee(ix, iy);
  EXPECT_EQ(count_all(traversability_of(flat_)).unknown, 40000);
}

TEST_F(Unknown, EmptyMapIsUnknown) {
  std::fill(flat_.height_m.begin(), flat_.height_m.end(), kUnseen);
  EXPECT_EQ(count_all(traversability_of(flat_)).unknown, 40000);
}

class Invariants : public testing::Test {
 protected:
  static TerrainGrid rough() {
    SyntheticMap spec;
    spec.noise_m = 0.012;
    spec.sigma_m = 0.012;
    TerrainGrid grid = synthetic_terrain(
        [](double x, double y) {
          return 0.15 * x + 0.6 * std::sin(0.4 * y) + block_m(x - 2.0, y - 1.0, 0.3, 0.3) +
                 block_m(x + 4.0, y - 3.0, 0.2, 0.2) + block_m(x + 1.0, y + 5.0, 0.12, 0.2);
        },
        spec);
    for (float& z : grid.height_m) z = std::round(z * 1024.0F) / 1024.0F;  // exact, also with metres added
    for (int iy = 120; iy < 140; ++iy)
      for (int ix = 20; ix < 60; ++ix) grid.height_m[grid.shape.at(ix, iy)] = kUnseen;
    return grid;
  }
  // Equal up to rounding.
  static void expect_same(const TraversabilityMap& a, const std::vector<std::uint8_t>& cells) {
    int differing = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) differing += std::abs(a.cells[i] - cells[i]) > 1;
    EXPECT_EQ(differing, 0);
  }
};

TEST_F(Invariants, CostsAreInvariantToQuarterTurn) {
  const TerrainGrid grid = rough();
  TerrainGrid turned = grid;
  const auto from = [&](int ix, int iy) { return grid.shape.at(iy, 199 - ix); };
  const TraversabilityMap map = traversability_of(grid);
  std::vector<std::uint8_t> expected(map.cells.size());
  for (int iy = 0; iy < 200; ++iy)
    for (int ix = 0; ix < 200; ++ix) {
      turned.height_m[grid.shape.at(ix, iy)] = grid.height_m[from(ix, iy)];
      expected[grid.shape.at(ix, iy)] = map.cells[from(ix, iy)];
    }
  expect_same(traversability_of(turned), expected);
}

TEST_F(Invariants, CostsAreInvariantToTranslation) {
  const TerrainGrid grid = rough();
  TerrainGrid moved = grid;
  moved.shape.origin_x_m += 1234.5;
  for (float& z : moved.height_m) z += 64.0F;
  expect_same(traversability_of(moved), traversability_of(grid).cells);
}

TEST_F(Invariants, SameMapGivesIdenticalCosts) {
  EXPECT_EQ(traversability_of(rough()).cells, traversability_of(rough()).cells);
}

}  // namespace
}  // namespace rover::trav
