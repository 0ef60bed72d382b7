// Cells of the whole plane in square tiles, each made at its first use.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

namespace rover::oracle {

template <class Cell>
class TiledGrid {
 public:
  static constexpr int kSide = 64;  // cells
  using Tile = std::vector<Cell>;   // index iy * kSide + ix

  // `fill` gets the lattice indices of the tile's first cell.
  explicit TiledGrid(double cell_m, std::function<void(int ix, int iy, Tile& tile)> fill = {})
      : cell_m_(cell_m), fill_(std::move(fill)) {}

  double cell_m() const { return cell_m_; }
  int index_of(double at_m) const { return static_cast<int>(std::floor(at_m / cell_m_)); }
  double center_m(int index) const { return (index + 0.5) * cell_m_; }

  Cell& at(int ix, int iy) {
    Tile& tile = tile_of(ix >> kShift, iy >> kShift);
    return tile[static_cast<size_t>((iy & (kSide - 1)) * kSide + (ix & (kSide - 1)))];
  }
  Cell& at_point(double x_m, double y_m) { return at(index_of(x_m), index_of(y_m)); }

 private:
  static constexpr int kShift = 6;

  Tile& tile_of(int tx, int ty) {
    const std::int64_t key = static_cast<std::int64_t>(tx) * 0x100000000 + ty;
    if (last_ != nullptr && key == last_key_) return *last_;
    Tile& tile = tiles_[key];
    if (tile.empty()) {
      tile.resize(kSide * kSide);
      if (fill_) fill_(tx * kSide, ty * kSide, tile);
    }
    last_key_ = key;
    last_ = &tile;
    return tile;
  }

  double cell_m_;
  std::function<void(int, int, Tile&)> fill_;
  std::unordered_map<std::int64_t, Tile> tiles_;
  std::int64_t last_key_ = 0;
  Tile* last_ = nullptr;
};

}  // namespace rover::oracle
