// What the maps of the Full level and the LocCam told of the ground around the rover, in odom: wider than one of them,
// so that a way that was found closed stays closed after it has left the newest.
#pragma once

#include <algorithm>

#include "common/core/grid_map.hpp"
#include "path_planner/hazard_memory.hpp"
#include "path_planner/traversability_grid.hpp"

namespace rover::planning {

struct GroundLook {
  std::uint8_t cost = TraversabilityGrid::kUnknown;
  double range_m = kInfinity;   // of the rover: the nearest of the maps that told of the cell; 0: LocCam
  double closed_m = kInfinity;  // likewise of those that found it impassable
};

class GroundMap {
 public:
  // A map from half as far again as an earlier one of a cell, and from further than `near_m`, does not change it: from
  // afar a gap that was found closed looks open again. What was found impassable is opened from clearly nearer
  // only: cells at the rim of a rock come and go.
  GroundMap(int cells, double cell_m, double near_m) : map_(cells, cell_m), near_m_(near_m) {}

  void clear() { map_.clear(); }
  void move_to(Point2 rover) { map_.move_to(rover.x_m, rover.y_m); }
  // What the map does not know keeps its value.
  void add(const TraversabilityGrid& grid, Point2 rover);
  // No way is left: the next map may open from anywhere what the ones before closed.
  void doubt_closed();
  // What the LocCam is sure of, before its memory loses it.
  void add(const HazardMemory& memory);

  const GridMap<GroundLook>& map() const { return map_; }

 private:
  GridMap<GroundLook> map_;
  double near_m_;
};

}  // namespace rover::planning
