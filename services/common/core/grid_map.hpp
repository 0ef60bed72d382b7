// Robot-centred grid in circular storage: cells keep their place in the world, and a move clears only the cells that
// enter the grid, without copying (as in grid_map and GA SLAM).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/check.hpp"

namespace rover {

// Cell in the world's lattice: covers [ix, ix + 1) x [iy, iy + 1) times the cell size.
struct CellIndex {
  int ix = 0;
  int iy = 0;
  friend bool operator==(const CellIndex&, const CellIndex&) = default;
};

template <class Cell>
class GridMap {
 public:
  // A square of cells x cells with the given side of a cell; every cell starts as `empty`.
  GridMap(int cells, double cell_m, Cell empty = Cell{})
      : cells_(cells), cell_m_(cell_m), empty_(empty), data_(static_cast<size_t>(cells) * cells, empty) {
    ROVER_CHECK(cells > 0 && cell_m > 0.0, cells, cell_m);
  }

  int cells() const { return cells_; }
  double cell_m() const { return cell_m_; }
  // Lattice index of the corner with the smallest x and y.
  CellIndex origin() const { return origin_; }

  CellIndex index_of(double x_m, double y_m) const {
    return {static_cast<int>(std::floor(x_m / cell_m_)), static_cast<int>(std::floor(y_m / cell_m_))};
  }
  double center_x_m(CellIndex i) const { return (i.ix + 0.5) * cell_m_; }
  double center_y_m(CellIndex i) const { return (i.iy + 0.5) * cell_m_; }

  bool contains(CellIndex i) const {
    return i.ix >= origin_.ix && i.iy >= origin_.iy && i.ix < origin_.ix + cells_ && i.iy < origin_.iy + cells_;
  }
  bool contains(double x_m, double y_m) const { return contains(index_of(x_m, y_m)); }

  Cell& at(CellIndex i) {
    ROVER_CHECK(contains(i), i.ix, i.iy, origin_.ix, origin_.iy, cells_);
    return data_[slot(i)];
  }
  const Cell& at(CellIndex i) const {
    ROVER_CHECK(contains(i), i.ix, i.iy, origin_.ix, origin_.iy, cells_);
    return data_[slot(i)];
  }
  // Outside the grid: the empty cell.
  const Cell& get(CellIndex i) const { return contains(i) ? data_[slot(i)] : empty_; }

  void clear() { std::fill(data_.begin(), data_.end(), empty_); }

  // Centres the grid on (x, y). Cells that leave it are lost.
  void move_to(double x_m, double y_m) {
    const CellIndex center = index_of(x_m, y_m);
    const CellIndex target{center.ix - cells_ / 2, center.iy - cells_ / 2};
    clear_leaving(origin_.ix, target.ix, true);
    clear_leaving(origin_.iy, target.iy, false);
    origin_ = target;
  }

  // Calls f(index, cell) for each cell, rows of growing y.
  template <class F>
  void for_each(F&& f) {
    for (int iy = origin_.iy; iy < origin_.iy + cells_; ++iy)
      for (int ix = origin_.ix; ix < origin_.ix + cells_; ++ix) f(CellIndex{ix, iy}, data_[slot({ix, iy})]);
  }
  template <class F>
  void for_each(F&& f) const {
    for (int iy = origin_.iy; iy < origin_.iy + cells_; ++iy)
      for (int ix = origin_.ix; ix < origin_.ix + cells_; ++ix) f(CellIndex{ix, iy}, data_[slot({ix, iy})]);
  }

 private:
  int wrap(int i) const {
    const int rest = i % cells_;
    return rest < 0 ? rest + cells_ : rest;
  }
  size_t slot(CellIndex i) const { return static_cast<size_t>(wrap(i.iy)) * cells_ + wrap(i.ix); }

  // Clears the columns (or rows) that leave the grid in the move from `from` to `to`.
  void clear_leaving(int from, int to, bool columns) {
    const int moved = std::min(std::abs(to - from), cells_);
    const int first = to > from ? from : from + cells_ - moved;
    for (int line = first; line < first + moved; ++line)
      for (int k = 0; k < cells_; ++k)
        data_[columns ? static_cast<size_t>(k) * cells_ + wrap(line) : static_cast<size_t>(wrap(line)) * cells_ + k] =
            empty_;
  }

  int cells_;
  double cell_m_;
  Cell empty_;
  CellIndex origin_{};
  std::vector<Cell> data_;
};

}  // namespace rover
