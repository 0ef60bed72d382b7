// Small test maps from height functions.
#pragma once

#include <cmath>
#include <limits>

#include "common/geo/elevation_raster.hpp"

namespace rover::orbital {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();

// height_m(x, y) at the cells' centres, in metres from the lower left corner.
template <class F>
ElevationRaster map_of(int width, int height, double cell_m, F&& height_m) {
  ElevationRaster map;
  map.width = width;
  map.height = height;
  map.resolution_m = cell_m;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      map.z_m.push_back(static_cast<float>(height_m((column + 0.5) * cell_m, (row + 0.5) * cell_m)));
  return map;
}

inline ElevationRaster level_map(int width, int height, double cell_m = 1.0) {
  return map_of(width, height, cell_m, [](double, double) { return 5.0; });
}

}  // namespace rover::orbital
