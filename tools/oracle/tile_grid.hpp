// Cells of a part of the map's lattice in square tiles that are made when first used.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "common/core/check.hpp"

namespace rover::oracle {

// Cells [x0, x1] x [y0, y1] of the lattice with this side; a new cell is Cell{}.
template <class Cell>
class TileGrid {
 public:
  TileGrid(double cell_m, double x0_m, double y0_m, double x1_m, double y1_m)
      : cell_m_(cell_m), first_x_(index(x0_m)), first_y_(index(y0_m)) {
    tiles_x_ = (index(x1_m) - first_x_) / kSide + 1;
    tiles_y_ = (index(y1_m) - first_y_) / kSide + 1;
    tiles_.resize(static_cast<size_t>(tiles_x_) * tiles_y_);
  }

  double cell_m() const { return cell_m_; }
  int index(double m) const { return static_cast<int>(std::floor(m / cell_m_)); }
  double centre_m(int i) const { return (i + 0.5) * cell_m_; }

  Cell& at(int ix, int iy) {
    const int x = ix - first_x_;
    const int y = iy - first_y_;
    ROVER_CHECK(x >= 0 && y >= 0 && x < tiles_x_ * kSide && y < tiles_y_ * kSide, ix, iy);
    std::unique_ptr<Cell[]>& tile = tiles_[static_cast<size_t>(y / kSide) * tiles_x_ + x / kSide];
    if (!tile) tile = std::make_unique<Cell[]>(kSide * kSide);
    return tile[static_cast<size_t>(y % kSide) * kSide + x % kSide];
  }

 private:
  static constexpr int kSide = 32;

  double cell_m_;
  int first_x_;
  int first_y_;
  int tiles_x_ = 0;
  int tiles_y_ = 0;
  std::vector<std::unique_ptr<Cell[]>> tiles_;
};

}  // namespace rover::oracle
