// Fraction of known cells in front of the rover in the Full-level costmap.
#pragma once

#include <cstdint>
#include <span>

#include "common/core/frames.hpp"

namespace rover::supervisor {

// Costmap aligned with odom, row-major along x.
struct CostmapView {
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // odom frame, corner with the smallest x and y
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  std::span<const std::uint8_t> cells;
  std::uint8_t unknown = 255;

  // Position in odom; cells outside the map are unknown.
  bool known(double x_m, double y_m) const;
};

// Known fractions 0 .. 1 of the area that a NavCam sweep covers.
struct KnownFractions {
  double ahead = 0.0;   // 1.2 .. 3 m ahead of the body origin, 0.6 m to each side
  double around = 0.0;  // 1.5 .. 4 m away, 10 .. 50 deg to the side, minimum of both sides
};

KnownFractions known_fractions(const CostmapView& map, const Pose2& body_odom);

}  // namespace rover::supervisor
