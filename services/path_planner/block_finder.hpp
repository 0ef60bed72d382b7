// How far the rover can follow its path: where the swept rectangle first meets a hazard or ground that was never seen.
#pragma once

#include <optional>

#include "path_planner/route.hpp"
#include "path_planner/terrain.hpp"

namespace rover::planning {

struct BlockQuery {
  const Terrain& terrain;
  const Route& route;
  Footprint footprint;
  double from_m = 0.0;  // along the route: where the rover is
  Pose2 rover;
  double margin_m = 0.0;
  bool turning = false;             // the rover turns on the spot to the route's heading first
  double turn_threshold_rad = 0.7;  // bends of the route above it are a point turn
  // A hazard nearer than the margin here may be left, but not come closer to; none: where the rover is.
  std::optional<Pose2> start{};
};

// Arc lengths along the route, infinity: not as far as the map reaches.
struct Block {
  double confirmed_m = kInfinity;
  double possible_m = kInfinity;
  double unseen_m = kInfinity;
};

Block find_block(const BlockQuery& query);

}  // namespace rover::planning
