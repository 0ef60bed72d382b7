// HAZARDS and TRAVERSABILITY as the planner takes them.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/time.hpp"
#include "path_planner/geometry.hpp"

namespace rover::planning {

struct InputGrid {
  static constexpr int kOutside = -1;

  Utime utime = kNever;
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // the corner with the smallest x and y
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  std::vector<std::uint8_t> cells;  // iy * cells_x + ix

  // The value at a point, in the frame of the grid.
  int at(Point2 p) const {
    const std::ptrdiff_t i = index_of(p);
    return i < 0 ? kOutside : cells[static_cast<size_t>(i)];
  }
  // Of the cell; negative outside.
  std::ptrdiff_t index_of(Point2 p) const {
    const double x = std::floor((p.x_m - origin_x_m) / cell_m);
    const double y = std::floor((p.y_m - origin_y_m) / cell_m);
    if (!(x >= 0.0 && y >= 0.0 && x < cells_x && y < cells_y)) return kOutside;
    return static_cast<std::ptrdiff_t>(y) * cells_x + static_cast<std::ptrdiff_t>(x);
  }
  // Why the grid is not usable; empty if it is.
  std::string fault(std::uint8_t max_value) const {
    constexpr int kMaxCells = 1 << 20;
    if (cells_x <= 0 || cells_y <= 0 || cells_x > kMaxCells / cells_y) return "grid size out of range";
    if (cells.size() != static_cast<size_t>(cells_x) * static_cast<size_t>(cells_y))
      return "grid size does not match its cells";
    if (!(cell_m >= 0.01 && cell_m <= 1.0)) return "cell size out of range";
    if (!std::isfinite(origin_x_m) || !std::isfinite(origin_y_m)) return "grid origin is not finite";
    for (const std::uint8_t cell : cells)
      if (cell > max_value) return "unknown cell value";
    return "";
  }
};

// In the body frame of the exposure.
struct HazardGrid : InputGrid {
  enum Cell : std::uint8_t { kUnseen = 0, kFree = 1, kObstacle = 2, kHole = 3, kMargin = 4, kLow = 5 };
  std::string fault() const { return InputGrid::fault(kLow); }
};

// Aligned with odom; cost of a cell from 0 (free), or one of the values below.
struct TraversabilityGrid : InputGrid {
  static constexpr std::uint8_t kLow = 253;
  static constexpr std::uint8_t kImpassable = 254;
  static constexpr std::uint8_t kUnknown = 255;
  std::vector<std::uint8_t> step_percent;  // rise within a wheel's diameter, of the limit
  std::vector<float> height_m;             // in odom; NaN: never seen
  std::string fault() const {
    const bool complete = step_percent.size() == cells.size() && height_m.size() == cells.size();
    return complete ? InputGrid::fault(kUnknown) : "steps or heights do not match the cells";
  }
};

}  // namespace rover::planning
