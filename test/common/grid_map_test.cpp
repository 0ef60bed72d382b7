#include "common/core/grid_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace rover {
namespace {

// Oracle: a std::map of cells within the window.
TEST(GridMap, MovesLikeAWindowOverTheWorld) {
  GridMap<int> grid(16, 0.5, -1);
  std::map<std::pair<int, int>, int> world;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(-3.0, 3.0);
  double x = 0.0;
  double y = 0.0;
  grid.move_to(x, y);
  for (int round = 0; round < 200; ++round) {
    const CellIndex at{grid.origin().ix + static_cast<int>(random() % 16),
                       grid.origin().iy + static_cast<int>(random() % 16)};
    grid.at(at) = round;
    world[{at.ix, at.iy}] = round;
    x += step(random);
    y += step(random);
    grid.move_to(x, y);
    std::erase_if(world, [&](const auto& cell) {
      return !grid.contains(CellIndex{cell.first.first, cell.first.second});
    });
    grid.for_each([&](CellIndex index, int value) {
      const auto it = world.find({index.ix, index.iy});
      EXPECT_EQ(value, it == world.end() ? -1 : it->second);
    });
  }
}

TEST(GridMap, IndexAndCentreAgreeOnBothSidesOfZero) {
  GridMap<int> grid(20, 0.1);
  grid.move_to(-0.02, 0.03);
  for (double x : {-0.95, -0.05, 0.0, 0.05, 0.86}) {
    const CellIndex index = grid.index_of(x, -x);
    EXPECT_NEAR(grid.center_x_m(index), x, 0.05 + 1e-12);
    EXPECT_NEAR(grid.center_y_m(index), -x, 0.05 + 1e-12);
  }
}

TEST(GridMap, OutsideIsEmptyAndNeverWritten) {
  GridMap<int> grid(4, 1.0, 9);
  EXPECT_EQ(grid.get({100, 100}), 9);
  EXPECT_DEATH(grid.at({100, 100}) = 1, "contains");
}

}  // namespace
}  // namespace rover
