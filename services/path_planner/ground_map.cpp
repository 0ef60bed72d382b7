#include "path_planner/ground_map.hpp"

namespace rover::planning {
namespace {

constexpr double kAsNear = 1.5;   // times the range of the nearest look
constexpr double kNearer = 0.85;  // times the range from which it was found impassable

}  // namespace

void GroundMap::add(const TraversabilityGrid& grid, Point2 rover) {
  const CellIndex low = map_.index_of(grid.origin_x_m, grid.origin_y_m);
  const CellIndex high =
      map_.index_of(grid.origin_x_m + grid.cells_x * grid.cell_m, grid.origin_y_m + grid.cells_y * grid.cell_m);
  const CellIndex origin = map_.origin();
  const int end_x = std::min(high.ix, origin.ix + map_.cells() - 1);
  const int end_y = std::min(high.iy, origin.iy + map_.cells() - 1);
  for (int iy = std::max(low.iy, origin.iy); iy <= end_y; ++iy)
    for (int ix = std::max(low.ix, origin.ix); ix <= end_x; ++ix) {
      const CellIndex i{ix, iy};
      const Point2 p{map_.center_x_m(i), map_.center_y_m(i)};
      const std::uint8_t cost = grid.at(p);
      if (cost == TraversabilityGrid::kUnknown) continue;
      GroundLook& look = map_.at(i);
      const double range_m = distance(p, rover);
      if (range_m > std::max(kAsNear * look.range_m, near_m_)) continue;
      look.range_m = std::min(look.range_m, range_m);
      if (cost == TraversabilityGrid::kImpassable) {
        look.closed_m = std::min(look.closed_m, range_m);
      } else if (look.cost == TraversabilityGrid::kImpassable && range_m > kNearer * look.closed_m) {
        continue;
      }
      look.cost = cost;
    }
}

void GroundMap::doubt_closed() {
  map_.for_each([](CellIndex, GroundLook& look) { look.closed_m = kInfinity; });
}

void GroundMap::add(const HazardMemory& memory) {
  memory.map().for_each([&](CellIndex i, const GroundCell& cell) {
    if (!map_.contains(i)) return;
    GroundLook& look = map_.at(i);
    if (memory.confirmed(cell))
      look = {TraversabilityGrid::kImpassable, 0.0, 0.0};
    else if (look.cost != TraversabilityGrid::kUnknown && memory.refutes(cell))
      look = {std::min(look.cost, TraversabilityGrid::kRefuted), 0.0, look.closed_m};
  });
}

}  // namespace rover::planning
