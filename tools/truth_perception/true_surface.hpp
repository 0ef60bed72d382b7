// Heights of the true surface, cached on a lattice and interpolated. One cache serves all maps of a run.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "rover_simulator/world/surface.hpp"

namespace rover::truth {

class TrueSurface {
 public:
  static constexpr double kSpacingM = 0.02;  // that of the simulator's finest tiles

  // `surface` must outlive this object.
  explicit TrueSurface(const Surface& surface) : surface_(surface) {}

  double height_m(double x_m, double y_m);
  // The highest lattice point in the closed square with this lower left corner.
  double top_m(double x_m, double y_m, double side_m);

 private:
  using Tile = std::vector<float>;
  const Tile& tile(std::int64_t column, std::int64_t row);

  const Surface& surface_;
  std::unordered_map<std::int64_t, Tile> tiles_;
  std::int64_t newest_key_ = 0;
  const Tile* newest_ = nullptr;  // neighbouring queries fall into the same tile
};

}  // namespace rover::truth
