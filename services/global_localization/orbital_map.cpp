#include "global_localization/orbital_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rover::global {
namespace {

HeightGrid part_of(const HeightGrid& grid, const CellRange& range) {
  const Lattice& all = grid.lattice;
  HeightGrid part;
  part.lattice = {range.end_column - range.first_column, range.end_row - range.first_row, all.cell_m,
                  all.x0_m + range.first_column * all.cell_m, all.y0_m + range.first_row * all.cell_m};
  for (int row = range.first_row; row < range.end_row; ++row)
    for (int column = range.first_column; column < range.end_column; ++column) {
      part.z_m.push_back(grid.z_m[all.index(column, row)]);
      part.weight.push_back(grid.weight[all.index(column, row)]);
    }
  return part;
}

// One row of blocks.
void append_merged(const HeightGrid& strip, int n, HeightGrid& result) {
  for (int column = 0; column + n <= strip.lattice.columns; column += n) {
    double sum = 0.0, weight = 0.0;
    for (int y = 0; y < n; ++y)
      for (int x = column; x < column + n; ++x) {
        const size_t i = strip.lattice.index(x, y);
        sum += static_cast<double>(strip.weight[i]) * strip.z_m[i];
        weight += strip.weight[i];
      }
    result.z_m.push_back(weight > 0.0 ? static_cast<float>(sum / weight) : 0.0f);
    result.weight.push_back(static_cast<float>(weight / (n * n)));
  }
}

}  // namespace

OrbitalMap::OrbitalMap(const Lattice& lattice, Read read) : lattice_(lattice), read_(std::move(read)) {}

OrbitalMap::OrbitalMap(HeightGrid in_memory)
    : lattice_(in_memory.lattice),
      read_([grid = std::move(in_memory)](const CellRange& range) { return part_of(grid, range); }) {}

HeightGrid OrbitalMap::around(const Eigen::Vector2d& center, double half_width_m, int n) const {
  const auto block = [&](double offset_m, int cells) {
    const double blocks = std::floor(offset_m / (n * lattice_.cell_m));
    return static_cast<int>(std::clamp(blocks, 0.0, static_cast<double>(cells / n)));
  };
  const Eigen::Vector2d p = center - Eigen::Vector2d(lattice_.x0_m, lattice_.y0_m);
  const CellRange blocks{block(p.x() - half_width_m, lattice_.columns), block(p.y() - half_width_m, lattice_.rows),
                         block(p.x() + half_width_m, lattice_.columns), block(p.y() + half_width_m, lattice_.rows)};
  if (n == 1) return read_(blocks);
  HeightGrid result;
  result.lattice = {blocks.end_column - blocks.first_column, blocks.end_row - blocks.first_row, n * lattice_.cell_m,
                    lattice_.x0_m + n * blocks.first_column * lattice_.cell_m,
                    lattice_.y0_m + n * blocks.first_row * lattice_.cell_m};
  for (int row = blocks.first_row; row < blocks.end_row; ++row)
    append_merged(read_({n * blocks.first_column, n * row, n * blocks.end_column, n * (row + 1)}), n, result);
  return result;
}

}  // namespace rover::global
