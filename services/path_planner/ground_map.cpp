#include "path_planner/ground_map.hpp"

namespace rover::planning {

void GroundMap::add(const TraversabilityGrid& grid) {
  const CellIndex low = map_.index_of(grid.origin_x_m, grid.origin_y_m);
  const CellIndex high =
      map_.index_of(grid.origin_x_m + grid.cells_x * grid.cell_m, grid.origin_y_m + grid.cells_y * grid.cell_m);
  const CellIndex origin = map_.origin();
  const int end_x = std::min(high.ix, origin.ix + map_.cells() - 1);
  const int end_y = std::min(high.iy, origin.iy + map_.cells() - 1);
  for (int iy = std::max(low.iy, origin.iy); iy <= end_y; ++iy)
    for (int ix = std::max(low.ix, origin.ix); ix <= end_x; ++ix) {
      const CellIndex i{ix, iy};
      const std::uint8_t value = grid.at({map_.center_x_m(i), map_.center_y_m(i)});
      if (value != TraversabilityGrid::kUnknown) map_.at(i) = value;
    }
}

}  // namespace rover::planning
