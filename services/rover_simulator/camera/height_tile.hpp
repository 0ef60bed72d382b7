// Square tiles of surface heights at three levels of detail.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <vector>

#include "rover_simulator/world/surface.hpp"

namespace rover {

// A level of detail: tiles of `cells` x `cells` squares of `spacing_m`.
struct TileLevel {
  int cells = 0;
  double spacing_m = 0.0;
  double skirt_m = 0.0;  // depth of the skirt that hides gaps to coarser neighbours
  double size_m() const { return cells * spacing_m; }
};

// Each tile size is a multiple of the finer one, so a tile is replaced by a whole block of finer tiles.
inline constexpr int kTileLevels = 3;
inline constexpr std::array<TileLevel, kTileLevels> kLevels = {TileLevel{200, 0.02, 0.06}, TileLevel{40, 0.1, 0.3},
                                                               TileLevel{20, 0.8, 2.0}};

// Tile (ix, iy) of a level covers [ix, ix + 1) x [iy, iy + 1) times the level's tile size.
struct TileKey {
  int level = 0;
  int ix = 0;
  int iy = 0;
  auto operator<=>(const TileKey&) const = default;
  double x_m() const { return ix * kLevels[level].size_m(); }
  double y_m() const { return iy * kLevels[level].size_m(); }
};

// Heights at the tile's vertices, with a border of one vertex.
struct HeightTile {
  TileKey key;
  double base_m = 0.0;        // heights are stored relative to this
  std::vector<float> height;  // (cells + 3)^2, rows along y

  HeightTile(const TileKey& tile_key, const Surface& surface);
  // i, j in [-1, cells + 1].
  float at(int i, int j) const {
    return height[static_cast<size_t>(j + 1) * (kLevels[key.level].cells + 3) + static_cast<size_t>(i + 1)];
  }
};

}  // namespace rover
