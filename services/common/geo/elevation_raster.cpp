#include "common/geo/elevation_raster.hpp"

#include <algorithm>
#include <cmath>

namespace rover {

ElevationRaster plane_raster(double width_m, double height_m, double resolution_m, double slope_rad,
                             double toward_rad) {
  ElevationRaster raster;
  raster.width = static_cast<int>(std::lround(width_m / resolution_m));
  raster.height = static_cast<int>(std::lround(height_m / resolution_m));
  raster.resolution_m = resolution_m;
  raster.projection_wkt = R"(LOCAL_CS["plane",UNIT["metre",1]])";  // a file of it is a map like any other
  raster.z_m.resize(static_cast<size_t>(raster.width) * raster.height);
  const double gx = std::tan(slope_rad) * std::cos(toward_rad), gy = std::tan(slope_rad) * std::sin(toward_rad);
  for (int row = 0; row < raster.height; ++row)
    for (int column = 0; column < raster.width; ++column)
      raster.at(column, row) = static_cast<float>(gx * column * resolution_m + gy * row * resolution_m);
  const float lowest = *std::min_element(raster.z_m.begin(), raster.z_m.end());
  for (float& z : raster.z_m) z -= lowest;
  return raster;
}

}  // namespace rover
