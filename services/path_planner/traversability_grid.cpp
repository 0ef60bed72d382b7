#include "path_planner/traversability_grid.hpp"

#include <cmath>

namespace rover::planning {
namespace {

constexpr int kMostMapCells = 1 << 20;

}  // namespace

std::uint8_t TraversabilityGrid::at(Point2 p) const {
  const double x = std::floor((p.x_m - origin_x_m) / cell_m);
  const double y = std::floor((p.y_m - origin_y_m) / cell_m);
  if (!(x >= 0.0 && y >= 0.0 && x < cells_x && y < cells_y)) return kUnknown;
  return cells[static_cast<size_t>(y) * static_cast<size_t>(cells_x) + static_cast<size_t>(x)];
}

std::string TraversabilityGrid::fault() const {
  if (cells_x <= 0 || cells_y <= 0 || cells_x > kMostMapCells / cells_y) return "grid size out of range";
  if (cells.size() != static_cast<size_t>(cells_x) * static_cast<size_t>(cells_y))
    return "grid size does not match its cells";
  if (!(cell_m >= 0.01 && cell_m <= 1.0)) return "cell size out of range";
  if (!std::isfinite(origin_x_m) || !std::isfinite(origin_y_m)) return "grid origin is not finite";
  return "";
}

}  // namespace rover::planning
