#include "rover_simulator/camera/height_tile.hpp"

#include <cmath>

#include "common/core/check.hpp"

namespace rover {

HeightTile::HeightTile(const TileKey& tile_key, const Surface& surface) : key(tile_key) {
  const TileLevel& level = kLevels[key.level];
  const int side = level.cells + 3;
  base_m = std::round(surface.height_m(key.x_m() + 0.5 * level.size_m(), key.y_m() + 0.5 * level.size_m()));
  ROVER_CHECK(std::isfinite(base_m), key.x_m(), key.y_m());
  height.reserve(static_cast<size_t>(side) * side);
  for (int j = -1; j < side - 1; ++j) {
    // Global lattice indices give neighbouring tiles identical samples on their common edge.
    const double y = (static_cast<double>(key.iy) * level.cells + j) * level.spacing_m;
    for (int i = -1; i < side - 1; ++i) {
      const double x = (static_cast<double>(key.ix) * level.cells + i) * level.spacing_m;
      const double z = surface.height_m(x, y);
      ROVER_CHECK(std::isfinite(z), x, y);
      height.push_back(static_cast<float>(z - base_m));
    }
  }
}

}  // namespace rover
