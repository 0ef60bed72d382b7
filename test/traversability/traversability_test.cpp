// Classes and costs on ground of known shape.
#include "traversability/traversability.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/core/frames.hpp"
#include "test/traversability/made_terrain.hpp"

namespace rover::trav {
namespace {

using namespace testing_support;

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

TraversabilityMap judge(const TerrainGrid& grid) {
  return judge_terrain(grid, {});
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
  MadeMap made;
  made.noise_m = noise_m;
  made.sigma_m = sigma_m;
  return make_terrain([&](double x, double y) { return 100.0 + gx * x + gy * y; }, made);
}

TEST(Slopes, EachCostsAsThePaperHasItUpToTheLimit) {
  // Cost 10/15/25/40 at 0/5/10/15 deg over that of flat ground, scaled to 253 at the limit of 19 deg.
  const double paper[] = {0.0, 5.0, 15.0, 30.0};
  for (int k = 0; k <= 3; ++k)
    for (double azimuth : {0.0, 30.0, 90.0, 225.0}) {
      const TraversabilityMap map = judge(plane(5.0 * k, azimuth));
      EXPECT_EQ(count_all(map).passable, 40000) << 5 * k << " deg at " << azimuth;
      EXPECT_NEAR(mean_cost(map), paper[k] * 253.0 / 45.0, 6.0) << 5 * k << " deg at " << azimuth;
    }
}

TEST(Slopes, BeyondTheLimitNothingIsPassable) {
  for (double azimuth : {0.0, 45.0, 160.0}) {
    EXPECT_EQ(count_all(judge(plane(18.0, azimuth))).passable, 40000);
    EXPECT_EQ(count_all(judge(plane(20.0, azimuth))).impassable, 40000);
    EXPECT_EQ(count_all(judge(plane(35.0, azimuth))).passable, 0);
  }
}

TEST(Slopes, NoiseWithinItsSigmaMakesNoObstacleAndLittleCost) {
  for (double slope : {0.0, 8.0, 15.0}) {
    const TraversabilityMap map = judge(plane(slope, 70.0, 0.015, 0.015));
    EXPECT_EQ(count_all(map).passable, 40000) << slope;
    EXPECT_NEAR(mean_cost(map), mean_cost(judge(plane(slope, 70.0))), 15.0) << slope;
  }
}

class Rocks : public testing::Test {
 protected:
  // A block in the middle of gently sloping ground.
  static TraversabilityMap with_block(double height_m, double radius_m, double noise_m, std::uint64_t seed) {
    MadeMap made;
    made.cells = 60;
    made.noise_m = noise_m;
    made.sigma_m = noise_m;
    const double x0 = 0.013 * static_cast<double>(seed % 8), y0 = 0.021 * static_cast<double>(seed % 5);
    return judge(make_terrain(
        [&](double x, double y) { return 0.1 * x - 0.05 * y + block_m(x - x0, y - y0, height_m, radius_m); }, made,
        seed));
  }
  static Count near(const TraversabilityMap& map, double distance_m) {
    return count(map, [&](double x, double y) { return std::hypot(x, y) < distance_m; });
  }
};

TEST_F(Rocks, FromTheHazardHeightOnTheyAreImpassableInEveryMap) {
  for (double height : {0.15, 0.20, 0.30})
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const TraversabilityMap map = with_block(height, 0.5 * height + 0.05, 0.01, seed);
      EXPECT_GT(near(map, 0.5 * height).impassable, 0) << height << " seed " << seed;
    }
}

TEST_F(Rocks, FromTwentyCentimetresOnNoCellOfThemIsPassable) {
  for (double height : {0.20, 0.30, 0.6})
    for (double radius : {0.12, 0.25, 0.5, 0.8})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const TraversabilityMap map = with_block(height, radius, 0.01, seed);
        const double x0 = 0.013 * static_cast<double>(seed % 8), y0 = 0.021 * static_cast<double>(seed % 5);
        const Count on = count(map, [&](double x, double y) { return std::hypot(x - x0, y - y0) <= radius; });
        EXPECT_EQ(on.passable, 0) << height << " m of radius " << radius << " seed " << seed;
      }
}

TEST_F(Rocks, OfTenCentimetresTheyAreDearButPassable) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const TraversabilityMap map = with_block(0.10, 0.15, 0.005, seed);
    EXPECT_EQ(count_all(map).impassable, 0) << seed;
    int dearest = 0;
    for (int iy = 25; iy < 35; ++iy)
      for (int ix = 25; ix < 35; ++ix) dearest = std::max<int>(dearest, map.cells[map.shape.at(ix, iy)]);
    EXPECT_GT(dearest, 80) << seed;
  }
}

TEST_F(Rocks, TheTopBelongsToThemWhereTheFarSideWasNotSeen) {
  TerrainGrid grid = make_terrain([](double x, double y) { return block_m(x, y, 0.3, 0.6); }, {.cells = 60});
  for (int iy = 0; iy < 60; ++iy)
    for (int ix = 30; ix < 60; ++ix)
      if (std::abs(iy - 30) < 8) grid.height_m[grid.shape.at(ix, iy)] = kUnseen;
  const TraversabilityMap map = judge(grid);
  const Count top = count(map, [](double x, double y) { return x < 0.0 && std::hypot(x, y) < 0.6; });
  EXPECT_EQ(top.passable, 0);
  EXPECT_GT(top.impassable, 40);
}

TEST_F(Rocks, TheGroundBesideThemStaysPassable) {
  for (double height : {0.2, 0.3, 0.6}) {
    const TraversabilityMap map = with_block(height, 0.3, 0.005, 3);
    const Count beside = count(map, [](double x, double y) {
      const double r = std::hypot(x - 0.039, y - 0.063);
      return r > 0.3 + 0.15 && r < 1.5;
    });
    EXPECT_EQ(beside.impassable, 0) << height;
    EXPECT_EQ(beside.unknown, 0) << height;
  }
}

TEST(Ledges, AreImpassableAndTheGroundAboveAndBelowIsNot) {
  const TraversabilityMap map = judge(make_terrain([](double x, double) { return x > 0.0 ? 0.2 : 0.0; }));
  for (int iy = 0; iy < 200; ++iy) {
    EXPECT_EQ(map.cells[map.shape.at(100, iy)], kImpassable);
    EXPECT_EQ(map.cells[map.shape.at(99, iy)], kImpassable);
  }
  EXPECT_EQ(count(map, [](double x, double) { return x > 0.3 || x < -0.15; }).impassable, 0);
}

TEST(Ledges, DitchesAreClosedToTheRover) {
  const auto ditch = [](double x, double y) { return std::abs(x) < 0.3 && std::abs(y) < 1.2 ? -0.3 : 0.0; };
  const TraversabilityMap map = judge(make_terrain(ditch));
  EXPECT_EQ(count(map, [](double x, double y) { return std::abs(x) < 0.3 && std::abs(y) < 1.2; }).passable, 0);
  EXPECT_EQ(count(map, [](double x, double y) { return std::abs(x) > 0.55 || std::abs(y) > 1.45; }).impassable, 0);
}

TEST(Belly, AConeThatLiftsTheBodyOffTheWheelsIsImpassable) {
  // Of 27 deg: over the whole disc it has no slope, over a wheel's reach no step.
  const TerrainGrid cone = make_terrain([](double x, double y) { return 0.5 * std::max(0.0, 0.9 - std::hypot(x, y)); });
  const auto top = [](double x, double y) { return std::hypot(x, y) < 0.2; };
  TraversabilityConfig config;
  EXPECT_GT(count(judge_terrain(cone, config), top).impassable, 0);
  config.belly_clearance_m = 1.0;
  EXPECT_EQ(count(judge_terrain(cone, config), top).impassable, 0);
}

class Unknown : public testing::Test {
 protected:
  void unsee(int ix, int iy) { flat_.height_m[flat_.shape.at(ix, iy)] = kUnseen; }
  std::uint8_t cell(int ix, int iy) const { return judge(flat_).cells[flat_.shape.at(ix, iy)]; }

  TerrainGrid flat_ = plane(0.0, 0.0);
};

TEST_F(Unknown, WhatWasNotSeenIsNeitherFreeNorImpassable) {
  for (int iy = 50; iy < 60; ++iy)
    for (int ix = 50; ix < 70; ++ix) unsee(ix, iy);
  const TraversabilityMap map = judge(flat_);
  EXPECT_EQ(count_all(map).unknown, 200);
  EXPECT_EQ(count_all(map).impassable, 0);
}

TEST_F(Unknown, HolesOfACellOrTwoInEvenGroundAreClosedAndThreeAreNot) {
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

TEST_F(Unknown, TheShadowOfARockStaysOpen) {
  flat_.height_m[flat_.shape.at(50, 50)] += 0.25F;
  unsee(51, 50);
  EXPECT_EQ(cell(51, 50), kUnknown);
}

TEST_F(Unknown, HeightsWithoutACertainSigmaAreNotSeen) {
  const float bad[] = {kUnseen, 0.2F, std::numeric_limits<float>::infinity(), -0.01F};
  for (int k = 0; k < 4; ++k)
    for (int iy = 50; iy < 55; ++iy)
      for (int ix = 50 + 10 * k; ix < 55 + 10 * k; ++ix) flat_.sigma_m[flat_.shape.at(ix, iy)] = bad[k];
  for (int iy = 100; iy < 105; ++iy)
    for (int ix = 100; ix < 105; ++ix) flat_.height_m[flat_.shape.at(ix, iy)] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(count_all(judge(flat_)).unknown, 125);
}

TEST_F(Unknown, AStepWithinItsOwnUncertaintyIsNotFreeNorCertain) {
  for (float sigma : {0.005F, 0.055F}) {
    TerrainGrid grid = flat_;
    const std::size_t i = grid.shape.at(60, 60);
    grid.height_m[i] += 0.2F;
    for (int iy = 55; iy < 66; ++iy)
      for (int ix = 55; ix < 66; ++ix) grid.sigma_m[grid.shape.at(ix, iy)] = sigma;
    EXPECT_EQ(judge(grid).cells[i], sigma < 0.01F ? kImpassable : kUnknown);
  }
}

TEST_F(Unknown, ACellAloneHasNoSlope) {
  for (int iy = 0; iy < 200; ++iy)
    for (int ix = 0; ix < 200; ++ix)
      if (std::abs(ix - 100) > 1 || std::abs(iy - 100) > 1) unsee(ix, iy);
  EXPECT_EQ(count_all(judge(flat_)).unknown, 40000);
}

TEST_F(Unknown, AnEmptyMapIsUnknown) {
  std::fill(flat_.height_m.begin(), flat_.height_m.end(), kUnseen);
  EXPECT_EQ(count_all(judge(flat_)).unknown, 40000);
}

class Laws : public testing::Test {
 protected:
  static TerrainGrid rough() {
    MadeMap made;
    made.noise_m = 0.012;
    made.sigma_m = 0.012;
    TerrainGrid grid = make_terrain(
        [](double x, double y) {
          return 0.15 * x + 0.6 * std::sin(0.4 * y) + block_m(x - 2.0, y - 1.0, 0.3, 0.3) +
                 block_m(x + 4.0, y - 3.0, 0.2, 0.2) + block_m(x + 1.0, y + 5.0, 0.12, 0.2);
        },
        made);
    for (float& z : grid.height_m) z = std::round(z * 1024.0F) / 1024.0F;  // exact, also with metres added
    for (int iy = 120; iy < 140; ++iy)
      for (int ix = 20; ix < 60; ++ix) grid.height_m[grid.shape.at(ix, iy)] = kUnseen;
    return grid;
  }
  // Equal up to the rounding of sums.
  static void expect_same(const TraversabilityMap& a, const std::vector<std::uint8_t>& cells) {
    int differing = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) differing += std::abs(a.cells[i] - cells[i]) > 1;
    EXPECT_EQ(differing, 0);
  }
};

TEST_F(Laws, AQuarterTurnOfTheGroundTurnsTheCosts) {
  const TerrainGrid grid = rough();
  TerrainGrid turned = grid;
  const auto from = [&](int ix, int iy) { return grid.shape.at(iy, 199 - ix); };
  const TraversabilityMap map = judge(grid);
  std::vector<std::uint8_t> expected(map.cells.size());
  for (int iy = 0; iy < 200; ++iy)
    for (int ix = 0; ix < 200; ++ix) {
      turned.height_m[grid.shape.at(ix, iy)] = grid.height_m[from(ix, iy)];
      expected[grid.shape.at(ix, iy)] = map.cells[from(ix, iy)];
    }
  expect_same(judge(turned), expected);
}

TEST_F(Laws, HeightAndPlaceOfTheMapDoNotMatter) {
  const TerrainGrid grid = rough();
  TerrainGrid moved = grid;
  moved.shape.origin_x_m += 1234.5;
  for (float& z : moved.height_m) z += 64.0F;
  expect_same(judge(moved), judge(grid).cells);
}

TEST_F(Laws, TheSameMapGivesTheSameBytes) {
  EXPECT_EQ(judge(rough()).cells, judge(rough()).cells);
}

}  // namespace
}  // namespace rover::trav
