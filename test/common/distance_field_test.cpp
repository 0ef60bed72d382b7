// Compares the distance transform with brute force.
#include "common/core/distance_field.hpp"

#include <gtest/gtest.h>

#include "common/core/frames.hpp"
#include "test/common/randoms.hpp"

namespace rover {
namespace {

using testing_support::uniform;

struct Grid {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> marked;
};

Grid random_grid(int width, int height, double density, std::mt19937_64& random) {
  Grid grid{width, height, {}};
  for (int i = 0; i < width * height; ++i) grid.marked.push_back(uniform(random, 0.0, 1.0) < density ? 1 : 0);
  return grid;
}

std::vector<double> brute_force(const Grid& grid, double cell_m) {
  std::vector<double> out(grid.marked.size(), kInfinity);
  for (size_t i = 0; i < out.size(); ++i)
    for (size_t k = 0; k < out.size(); ++k) {
      if (!grid.marked[k]) continue;
      const int dx = static_cast<int>(i) % grid.width - static_cast<int>(k) % grid.width;
      const int dy = static_cast<int>(i) / grid.width - static_cast<int>(k) / grid.width;
      out[i] = std::min(out[i], cell_m * std::hypot(dx, dy));
    }
  return out;
}

TEST(DistanceField, AgreesWithBruteForceAtEveryDensity) {
  std::mt19937_64 random(1);
  for (const double density : {0.0, 0.001, 0.01, 0.1, 0.5, 1.0})
    for (const auto& [width, height] : {std::pair{37, 23}, std::pair{23, 37}, std::pair{1, 40}, std::pair{40, 1}}) {
      const Grid grid = random_grid(width, height, density, random);
      const std::vector<double> expected = brute_force(grid, 0.1);
      const std::vector<double> field = distance_field(grid.marked, width, height, 0.1);
      ASSERT_EQ(field.size(), expected.size());
      for (size_t i = 0; i < field.size(); ++i) {
        if (std::isinf(expected[i]))
          ASSERT_EQ(field[i], kInfinity);
        else
          ASSERT_NEAR(field[i], expected[i], 1e-9) << width << " x " << height << " cell " << i;
      }
    }
}

TEST(DistanceField, NothingMarkedIsInfinitelyFar) {
  for (const double d : distance_field(std::vector<std::uint8_t>(100, 0), 10, 10, 0.1)) EXPECT_EQ(d, kInfinity);
}

}  // namespace
}  // namespace rover
