// Writes a map of Mars-like relief for bench large_map: the terrain of a small map stretched to the wanted size with
// its slopes kept, and its own detail on top, mirrored from tile to tile.
//   make_large_map MAP.tif SIDE_M RESOLUTION_M OUT.tif
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "common/geo/elevation_map.hpp"
#include "common/geo/geotiff_writer.hpp"

namespace {

using rover::ElevationRaster;

constexpr double kDetail = 0.5;  // amplitude of the small relief

// Bilinear, in pixels; mirrored beyond the map.
double height_at(const ElevationRaster& map, double x, double y) {
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

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::fprintf(stderr, "usage: make_large_map MAP.tif SIDE_M RESOLUTION_M OUT.tif\n");
    return 2;
  }
  const ElevationRaster small = rover::read_elevation_map(argv[1]).raster;
  const double side_m = std::stod(argv[2]);
  ElevationRaster large = small;
  large.resolution_m = std::stod(argv[3]);
  large.width = large.height = static_cast<int>(side_m / large.resolution_m);
  large.z_m.resize(static_cast<size_t>(large.width) * large.height);
  const double stretch = side_m / std::min(small.width_m(), small.height_m());
  const double step = large.resolution_m / small.resolution_m;
  for (int row = 0; row < large.height; ++row)
    for (int column = 0; column < large.width; ++column)
      large.at(column, row) =
          static_cast<float>(stretch * height_at(small, column * step / stretch, row * step / stretch) +
                             kDetail * height_at(small, column * step, row * step));
  rover::write_geotiff(argv[4], large);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_large_map: %s\n", error.what());
  return 2;
}
