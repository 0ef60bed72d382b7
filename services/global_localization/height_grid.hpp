// Regular grid of weighted heights, or of a picture's brightness. Row 0 has the smallest y.
#pragma once

#include <cstddef>
#include <vector>

namespace rover::global {

struct Lattice {
  int columns = 0;
  int rows = 0;
  double cell_m = 1.0;
  double x0_m = 0.0;  // corner with the smallest x and y
  double y0_m = 0.0;

  size_t size() const { return static_cast<size_t>(columns) * static_cast<size_t>(rows); }
  size_t index(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
  }
  bool contains(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  double center_x_m(int column) const { return x0_m + (column + 0.5) * cell_m; }
  double center_y_m(int row) const { return y0_m + (row + 0.5) * cell_m; }
};

struct HeightGrid {
  Lattice lattice;
  std::vector<float> z_m;     // or brightness; any finite value where the weight is 0
  std::vector<float> weight;  // observed fraction of the cell, 0 to 1
};

}  // namespace rover::global
