// How far the rover can follow its path: where the swept footprint first meets a hazard or unknown ground.
#pragma once

#include <optional>

#include "path_planner/expected_motion.hpp"
#include "path_planner/search/footprint_check.hpp"
#include "path_planner/search/roll.hpp"

namespace rover::planning {

struct MonitorQuery {
  const Costmap& costmap;
  const Route& route;
  Footprint footprint;
  double from_m = 0.0;  // along the route: where the rover is
  Pose2 rover;
  Pose2 planned_from;  // where the rover was then
  double margin_m = 0.0;
  RollCosts roll;
  bool turning = false;  // the rover turns on the spot to the heading of the route first
  ViewArea view;
  SideSlip side_slip;
};

// Arc lengths along the route; infinity: clear as far as the costmap reaches.
struct Blockage {
  double hazard_m = kInfinity;
  double unknown_m = kInfinity;
  double unseen_m = kInfinity;  // unknown, and not seen on the path to it either
};

Blockage find_blockage(const MonitorQuery& query);

}  // namespace rover::planning
