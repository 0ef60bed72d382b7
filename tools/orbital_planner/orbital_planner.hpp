// From an orbital elevation model to the globally best path with the level of autonomy of each stretch.
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

struct Stretch {
  size_t first = 0;  // points of the path; the last one of a stretch is the first of the next
  size_t last = 0;
  Level level = Level::kEfficient;
  double length_m = 0.0;
  double mean_difficulty = 0.0;
  double most_slope_rad = 0.0;
};

enum class PlanStatus : std::int8_t {
  kPlanned,
  kOutside,      // the way-point lies outside of the map
  kNoData,       // ... where the map says nothing
  kNotClear,     // ... nearer to an obstacle or to unknown ground than the clearance
  kUnreachable,  // no way leads to it from the way-point before
};

struct Plan {
  PlanStatus status = PlanStatus::kPlanned;  // read first
  size_t waypoint = 0;                       // the one that the status is about
  double obstacle_distance_m = kNaN;         // kNotClear
  TerrainLayers terrain;
  Line line;
  std::vector<double> difficulty;  // expected at each point
  std::vector<Level> level;        // from each point on
  std::vector<Stretch> stretches;
  double length_m = 0.0;
  double cost_m = 0.0;  // metres of level ground that would cost as much
};

// Way-points in map coordinates: start, any number in between, goal.
Plan plan(const ElevationRaster& map, const Line& waypoints, const PlannerConfig& config);

}  // namespace rover::orbital
