// Globally optimal path on an orbital elevation model, with the level of autonomy of each segment.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/orbital_planner/levels.hpp"
#include "tools/orbital_planner/route.hpp"
#include "tools/orbital_planner/terrain.hpp"
#include "tools/orbital_planner/travel_cost.hpp"

namespace rover::orbital {

struct PlannerConfig {
  TerrainConfig terrain;
  CostConfig cost;
  RouteConfig route;
  LevelConfig levels;
};

struct PathSegment {
  size_t first = 0;  // point indices; the last point of a segment is the first of the next
  size_t last = 0;
  Level level = Level::kEfficient;
  double length_m = 0.0;
  double mean_difficulty = 0.0;
  double max_slope_rad = 0.0;
};

enum class PlanStatus : std::int8_t {
  kPlanned,
  kOutside,      // the waypoint is outside of the map
  kNoData,       // the waypoint has no map data
  kForbidden,    // a zone forbids the waypoint
  kNotClear,     // the waypoint is closer to an obstacle, a zone or unknown ground than the clearance
  kUnreachable,  // no path from the previous waypoint
};

struct Plan {
  PlanStatus status = PlanStatus::kPlanned;  // read first
  size_t waypoint = 0;                       // the waypoint that the status refers to
  double obstacle_distance_m = kNaN;         // kNotClear
  std::vector<Zone> zones;
  TerrainLayers terrain;
  Line line;
  std::vector<double> difficulty;  // expected difficulty at each point
  std::vector<Level> level;        // level from each point on
  std::vector<PathSegment> segments;
  double length_m = 0.0;
  double cost_m = 0.0;  // equivalent distance on level ground
};

// `terrain`: of analyse(). Waypoints in map coordinates: start, any number of intermediate points, goal. The path keeps
// the clearance to zones.
Plan plan(TerrainLayers terrain, const Line& waypoints, const PlannerConfig& config,
          const std::vector<Zone>& zones = {});

}  // namespace rover::orbital
