// The orbital map in the map frame, of which only parts are read: it can be larger than the memory.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "global_localization/height_grid.hpp"

namespace rover::global {

struct CellRange {
  int first_column = 0;
  int first_row = 0;
  int end_column = 0;
  int end_row = 0;
};

class OrbitalMap {
 public:
  // May throw if the cells cannot be read.
  using Read = std::function<HeightGrid(const CellRange&)>;

  OrbitalMap(const Lattice& lattice, Read read);
  OrbitalMap(HeightGrid in_memory);  // NOLINT(google-explicit-constructor): a grid is a map

  // Of the whole map.
  const Lattice& lattice() const { return lattice_; }
  // The cells within the square about the centre, in blocks of n x n with their mean height and weight; those outside
  // of the map are left out.
  HeightGrid around(const Eigen::Vector2d& center, double half_width_m, int n = 1) const;

 private:
  Lattice lattice_;
  Read read_;
};

}  // namespace rover::global
