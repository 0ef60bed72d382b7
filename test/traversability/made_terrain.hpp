// Elevation maps of known ground: the mean height of each cell, with noise as large as the sigma says.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "test/common/randoms.hpp"
#include "traversability/traversability.hpp"

namespace rover::trav::testing_support {

inline double gaussian(std::mt19937_64& random) {
  const double u = rover::testing_support::uniform(random, 1e-12, 1.0);
  const double v = rover::testing_support::uniform(random, 0.0, 1.0);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

struct MadeMap {
  int cells = 200;
  double cell_m = 0.1;
  double center_x_m = 0.0;
  double center_y_m = 0.0;
  double noise_m = 0.0;
  double sigma_m = 0.01;
  int samples = 4;  // along a cell's side
};

// `height(x, y)` in metres.
template <class Height>
TerrainGrid make_terrain(Height&& height, const MadeMap& made = {}, std::uint64_t seed = 1) {
  TerrainGrid grid;
  const double half_m = 0.5 * made.cells * made.cell_m;
  grid.shape = {made.cells, made.cells, made.cell_m, made.center_x_m - half_m, made.center_y_m - half_m};
  grid.sigma_m.assign(grid.shape.size(), static_cast<float>(made.sigma_m));
  std::mt19937_64 random(seed);
  for (int iy = 0; iy < made.cells; ++iy)
    for (int ix = 0; ix < made.cells; ++ix) {
      double sum = 0.0;
      for (int j = 0; j < made.samples; ++j)
        for (int i = 0; i < made.samples; ++i)
          sum += height(grid.shape.x_m(ix) + ((i + 0.5) / made.samples - 0.5) * made.cell_m,
                        grid.shape.y_m(iy) + ((j + 0.5) / made.samples - 0.5) * made.cell_m);
      grid.height_m.push_back(
          static_cast<float>(sum / (made.samples * made.samples) + made.noise_m * gaussian(random)));
    }
  return grid;
}

// Height of an upright block with a round outline over flat ground.
inline double block_m(double x, double y, double height_m, double radius_m) {
  return std::hypot(x, y) <= radius_m ? height_m : 0.0;
}

struct Count {
  int passable = 0, impassable = 0, unknown = 0;
};

// Classes of the cells whose centre lies where `in(x, y)` says.
template <class In>
Count count(const TraversabilityMap& map, In&& in) {
  Count out;
  for (int iy = 0; iy < map.shape.cells_y; ++iy)
    for (int ix = 0; ix < map.shape.cells_x; ++ix) {
      if (!in(map.shape.x_m(ix), map.shape.y_m(iy))) continue;
      const std::uint8_t cost = map.cells[map.shape.at(ix, iy)];
      ++(cost == kUnknown ? out.unknown : cost == kImpassable ? out.impassable : out.passable);
    }
  return out;
}

inline Count count_all(const TraversabilityMap& map) {
  return count(map, [](double, double) { return true; });
}

}  // namespace rover::trav::testing_support
