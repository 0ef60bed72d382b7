// Cache of surface heights on a 1 cm grid, interpolated bilinearly: wheels query hundreds of heights per step and move
// 0.4 mm between steps. The result does not depend on the order of queries.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rover_simulator/world/surface.hpp"

namespace rover {

class HeightCache {
 public:
  explicit HeightCache(const Surface& surface);

  double height_m(double x_m, double y_m);
  Material material(double x_m, double y_m);  // of the nearest sample

 private:
  static constexpr int kCells = 32;  // per tile side, with kCells + 1 samples
  struct Tile {
    std::int64_t tx = INT64_MIN;
    std::int64_t ty = INT64_MIN;
    std::vector<float> height_m;
    std::vector<Material> material;  // empty until first queried
  };

  Tile& tile_at(std::int64_t tx, std::int64_t ty);
  void fill_material(Tile& tile);

  const Surface& surface_;
  std::vector<Tile> slots_;
};

}  // namespace rover
