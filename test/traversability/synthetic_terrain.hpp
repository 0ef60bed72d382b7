// Elevation maps of analytic ground: mean height per cell plus Gaussian noise.
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

struct SyntheticMap {
  int cells = 200;
  double cell_m = 0.1;
  double center_x_m = 0.0;
  double center_y_m = 0.0;
  double noise_m = 0.0;
  double sigma_m = 0.01;
  int samples = 4;  // per cell side
};

// `height(x, y)` in metres.
template <class Height>
TerrainGrid synthetic_terrain(Height&& height, const SyntheticMap& spec = {}, std::uint64_t seed = 1) {
  TerrainGrid grid;
  const double half_m = 0.5 * spec.cells * spec.cell_m;
  grid.shape = {spec.cells, spec.cells, spec.cell_m, spec.center_x_m - half_m, spec.center_y_m - half_m};
  grid.sigma_m.assign(grid.shape.size(), static_cast<float>(spec.sigma_m));
  std::mt19937_64 random(seed);
  for (int iy = 0; iy < spec.cells; ++iy)
    for (int ix = 0; ix < spec.cells; ++ix) {
      double sum = 0.0;
      for (int j = 0; j < spec.samples; ++j)
        for (int i = 0; i < spec.samples; ++i)
          sum += height(grid.shape.x_m(ix) + ((i + 0.5) / spec.samples - 0.5) * spec.cell_m,
                        grid.shape.y_m(iy) + ((j + 0.5) / spec.samples - 0.5) * spec.cell_m);
      grid.height_m.push_back(
          static_cast<float>(sum / (spec.samples * spec.samples) + spec.noise_m * gaussian(random)));
    }
  return grid;
}

// Height of an upright cylinder on flat ground.
inline double block_m(double x, double y, double height_m, double radius_m) {
  return std::hypot(x, y) <= radius_m ? height_m : 0.0;
}

struct Count {
  int passable = 0, impassable = 0, unknown = 0;
};

// Counts the classes of cells whose centre satisfies `in(x, y)`.
template <class In>
Count count(const TraversabilityMap& map, In&& in) {
  Count out;
  for (int iy = 0; iy < map.shape.cells_y; ++iy)
    for (int ix = 0; ix < map.shape.cells_x; ++ix) {
      if (!in(map.shape.x_m(ix), map.shape.y_m(iy))) continue;
      const std::uint8_t cost = map.cells[map.shape.at(ix, iy)];
      ++(cost == kUnknown ? out.unknown : cost >= kLow ? out.impassable : out.passable);
    }
  return out;
}

inline Count count_all(const TraversabilityMap& map) {
  return count(map, [](double, double) { return true; });
}

}  // namespace rover::trav::testing_support
