// What the maps of the Full level told of the ground around the rover, in odom: wider than one of them, so that a way
// that was found closed stays closed after it has left the newest.
#pragma once

#include <algorithm>

#include "common/core/grid_map.hpp"
#include "path_planner/traversability_grid.hpp"

namespace rover::planning {

class GroundMap {
 public:
  GroundMap(int cells, double cell_m) : map_(cells, cell_m, TraversabilityGrid::kUnknown) {}

  void clear() { map_.clear(); }
  void move_to(Point2 rover) { map_.move_to(rover.x_m, rover.y_m); }
  // What the newest map does not know keeps its value.
  void add(const TraversabilityGrid& grid);

  const GridMap<std::uint8_t>& map() const { return map_; }

 private:
  GridMap<std::uint8_t> map_;
};

}  // namespace rover::planning
