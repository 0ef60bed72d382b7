#include "tools/truth_perception/true_terrain.hpp"

#include <gtest/gtest.h>

#include "test/truth_perception/scene.hpp"
#include "traversability/traversability.hpp"

namespace rover::truth {
namespace {

class TrueTerrainTest : public testing::Test {
 protected:
  trav::TraversabilityMap map_of(const std::vector<Block>& blocks, const Pose2& odom = {10.0, 10.0, 0.0}) {
    world_.blocks = blocks;
    TrueTerrain terrain(200, kCellM, std::make_shared<TrueSurface>(world_));
    for (const double x : {10.0, 10.5}) terrain.add(navcam_at(x, 10.0, world_.slope_x * x));
    trav::TraversabilityConfig config;
    config.step.mean_height_ratio = 1.0;
    const trav::GridShape shape{200, 200, kCellM, std::floor(odom.x_m) - 10.0, std::floor(odom.y_m) - 10.0};
    return trav::compute_traversability(terrain.grid(shape, {10.0, 10.0, 0.0}, odom), config);
  }
  static std::uint8_t at(const trav::TraversabilityMap& map, double x_m, double y_m) {
    return map.cells[map.shape.at(static_cast<int>(std::floor((x_m - map.shape.origin_x_m) / kCellM)),
                                  static_cast<int>(std::floor((y_m - map.shape.origin_y_m) / kCellM)))];
  }
  static auto count(const trav::TraversabilityMap& map, std::uint8_t cost) {
    return std::count(map.cells.begin(), map.cells.end(), cost);
  }

  Blocks world_;
};

TEST_F(TrueTerrainTest, RockOfFourteenCentimetresIsPassable) {
  const trav::TraversabilityMap map = map_of({{13.0, 10.1, 0.2, 0.14}});
  EXPECT_EQ(count(map, trav::kLow) + count(map, trav::kImpassable), 0);
  EXPECT_LT(at(map, 13.0, 10.1), trav::kLow);
}

TEST_F(TrueTerrainTest, RockOfSixteenCentimetresIsLowWithOneRingOfCells) {
  const Block rock{13.0, 10.1, 0.2, 0.16};
  const trav::TraversabilityMap map = map_of({rock});
  for (int iy = 0; iy < map.shape.cells_y; ++iy)
    for (int ix = 0; ix < map.shape.cells_x; ++ix) {
      const double x = map.shape.x_m(ix), y = map.shape.y_m(iy);
      const std::uint8_t cost = map.cells[map.shape.at(ix, iy)];
      if (std::hypot(x - rock.x_m, y - rock.y_m) <= rock.radius_m) {
        EXPECT_EQ(cost, trav::kLow) << x << " " << y;
      }
      if (cost == trav::kLow) {
        EXPECT_TRUE(touches(rock, x, y, 3.0 * kCellM + 0.01)) << x << " " << y;
      }
    }
}

TEST_F(TrueTerrainTest, RockBehindATallerOneIsUnknown) {
  const Block low{14.5, 10.0, 0.15, 0.25}, tall{13.0, 10.0, 0.4, 0.8};
  EXPECT_EQ(at(map_of({low}), low.x_m, low.y_m), trav::kImpassable);
  const trav::TraversabilityMap map = map_of({tall, low});
  EXPECT_EQ(at(map, low.x_m, low.y_m), trav::kUnknown);
  EXPECT_EQ(at(map, tall.x_m - 0.3, tall.y_m), trav::kImpassable);
}

TEST_F(TrueTerrainTest, SlopeOfFifteenDegreesIsPassableAndOfTwentyTwoIsNot) {
  world_.slope_x = std::tan(to_rad(-15.0));
  const trav::TraversabilityMap passable = map_of({});
  EXPECT_EQ(count(passable, trav::kImpassable), 0);
  EXPECT_LT(at(passable, 13.0, 10.0), trav::kImpassable);
  world_.slope_x = std::tan(to_rad(22.0));
  EXPECT_EQ(at(map_of({}), 12.0, 10.0), trav::kImpassable);
}

TEST_F(TrueTerrainTest, RocksAreWhereDriftedOdometrySeesThem) {
  // Three metres ahead of a body that odom has at (-4, 2), turned by 90 deg.
  const trav::TraversabilityMap map = map_of({{13.0, 10.0, 0.2, 0.3}}, {-4.03, 2.02, 0.5 * kPi});
  EXPECT_EQ(at(map, -4.03, 2.02 + 3.0), trav::kImpassable);
  EXPECT_LT(at(map, -4.03 - 0.6, 2.02 + 3.0), trav::kImpassable);
}

TEST_F(TrueTerrainTest, GroundNeverLookedAtIsUnknown) {
  const trav::TraversabilityMap map = map_of({});
  EXPECT_EQ(at(map, 8.0, 10.0), trav::kUnknown);
  EXPECT_EQ(at(map, 13.0, 15.0), trav::kUnknown);
  EXPECT_GT(count(map, trav::kUnknown), 20000);
}

}  // namespace
}  // namespace rover::truth
