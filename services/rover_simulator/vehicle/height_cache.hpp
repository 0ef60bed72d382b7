// A window on the surface, sampled once per place at 1 cm and interpolated from then on: wheels ask for hundreds of
// heights a step and move 0.4 mm meanwhile. A pure function of the surface, whatever the order of questions.
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
  static constexpr int kCells = 32;  // of a tile's side; a tile holds one sample more
  struct Tile {
    std::int64_t tx = INT64_MIN;
    std::int64_t ty = INT64_MIN;
    std::vector<float> height_m;
    std::vector<Material> material;  // empty until asked for
  };

  Tile& tile_at(std::int64_t tx, std::int64_t ty);
  void fill_material(Tile& tile);

  const Surface& surface_;
  std::vector<Tile> slots_;
};

}  // namespace rover
