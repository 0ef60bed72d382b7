// TRAVERSABILITY as the planner keeps it: what the ground of each cell costs, in a grid aligned with odom.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/time.hpp"
#include "path_planner/geometry.hpp"

namespace rover::planning {

struct TraversabilityGrid {
  static constexpr std::uint8_t kImpassable = 254;
  static constexpr std::uint8_t kUnknown = 255;
  // The most that ground costs which the LocCam saw free: dear where the map takes it for a rock, no longer doubtful.
  static constexpr std::uint8_t kRefuted = 127;

  Utime utime = kNever;
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // odom coordinates of the corner with the smallest x and y
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  std::vector<std::uint8_t> cells;  // iy * cells_x + ix

  // Cost of the cell at a point in odom: 0 (free) .. kImpassable; kUnknown also outside.
  std::uint8_t at(Point2 p) const;
  // Why the grid is not usable; empty where it is.
  std::string fault() const;
};

}  // namespace rover::planning
