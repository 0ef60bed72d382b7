// A large terrain from a small map: its relief stretched to the wanted side with the slopes kept, and its own detail on
// top, mirrored from tile to tile. No place of it repeats.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/geo/elevation_raster.hpp"

namespace rover::testing_support {

// Bilinear, in pixels; mirrored beyond the map.
inline double mirrored_height(const ElevationRaster& map, double x, double y) {
  const auto mirrored = [](double v, int cells) {
    const double period = 2.0 * (cells - 1), within = std::fmod(v, period);
    return within < cells - 1 ? within : period - within;
  };
  const double u = mirrored(x, map.width), v = mirrored(y, map.height);
  const int i = std::min(static_cast<int>(u), map.width - 2), j = std::min(static_cast<int>(v), map.height - 2);
  const double a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * map.at(i, j) + a * map.at(i + 1, j)) +
         b * ((1 - a) * map.at(i, j + 1) + a * map.at(i + 1, j + 1));
}

inline ElevationRaster stretched_terrain(const ElevationRaster& small, double side_m, double resolution_m) {
  constexpr double kDetail = 0.5;  // amplitude of the small relief
  ElevationRaster large = small;
  large.resolution_m = resolution_m;
  large.width = large.height = static_cast<int>(side_m / resolution_m);
  large.z_m.resize(static_cast<size_t>(large.width) * large.height);
  const double stretch = side_m / std::min(small.width_m(), small.height_m());
  const double step = resolution_m / small.resolution_m, datum = small.at(0, 0);
  for (int row = 0; row < large.height; ++row)
    for (int column = 0; column < large.width; ++column)
      large.at(column, row) =
          static_cast<float>(stretch * (mirrored_height(small, column * step / stretch, row * step / stretch) - datum) +
                             kDetail * (mirrored_height(small, column * step, row * step) - datum));
  return large;
}

}  // namespace rover::testing_support
