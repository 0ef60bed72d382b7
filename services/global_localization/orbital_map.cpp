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

}  // namespace

OrbitalMap::OrbitalMap(const Lattice& lattice, Read read) : lattice_(lattice), read_(std::move(read)) {}

OrbitalMap::OrbitalMap(HeightGrid in_memory)
    : lattice_(in_memory.lattice),
      read_([grid = std::move(in_memory)](const CellRange& range) { return part_of(grid, range); }) {}

HeightGrid OrbitalMap::around(const Eigen::Vector2d& center, double half_width_m) const {
  const auto cell = [&](double offset_m, int max_index) {
    return static_cast<int>(std::clamp(std::floor(offset_m / lattice_.cell_m), 0.0, static_cast<double>(max_index)));
  };
  const Eigen::Vector2d p = center - Eigen::Vector2d(lattice_.x0_m, lattice_.y0_m);
  return read_({cell(p.x() - half_width_m, lattice_.columns), cell(p.y() - half_width_m, lattice_.rows),
                cell(p.x() + half_width_m, lattice_.columns), cell(p.y() + half_width_m, lattice_.rows)});
}

}  // namespace rover::global
