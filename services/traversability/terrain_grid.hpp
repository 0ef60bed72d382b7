// Grid of square cells aligned with odom, index iy * cells_x + ix.
#pragma once

#include <cstddef>
#include <vector>

namespace rover::trav {

struct GridShape {
  int cells_x = 0;
  int cells_y = 0;
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // corner with the smallest x and y
  double origin_y_m = 0.0;

  std::size_t size() const { return static_cast<std::size_t>(cells_x) * static_cast<std::size_t>(cells_y); }
  bool contains(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < cells_x && iy < cells_y; }
  std::size_t at(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(cells_x) + static_cast<std::size_t>(ix);
  }
  double x_m(int ix) const { return origin_x_m + (ix + 0.5) * cell_m; }
  double y_m(int iy) const { return origin_y_m + (iy + 0.5) * cell_m; }
};

// Heights relative to odom's origin; NaN: not seen.
struct TerrainGrid {
  GridShape shape;
  std::vector<float> height_m;
  std::vector<float> sigma_m;
};

}  // namespace rover::trav
