// How much of the ground before the rover the Full level's cost map knows.
#pragma once

#include <cstdint>
#include <span>

#include "common/core/frames.hpp"

namespace rover::supervisor {

// A cost map aligned with odom, row by row along x.
struct CostView {
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // odom, of the corner with the smallest x and y
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  std::span<const std::uint8_t> cells;
  std::uint8_t unknown = 255;

  // Of the place in odom; what lies outside is not known.
  bool known(double x_m, double y_m) const;
};

// Shares 0 .. 1 of what a sweep of the NavCam shows, on the next metres of a straight way and to both sides.
struct KnownShares {
  double ahead = 0.0;   // 1.2 .. 3 m before the body's origin, 0.6 m to each side
  double around = 0.0;  // 1.5 .. 4 m away, 10 .. 50 deg to the side of which less is known
};

KnownShares known_shares(const CostView& map, const Pose2& body_odom);

}  // namespace rover::supervisor
