// What a metre of way costs on each cell: 1 on level, smooth ground; infinity where the rover may not be.
#pragma once

#include <vector>

#include "common/core/fast_marching.hpp"
#include "tools/orbital_planner/terrain.hpp"

namespace rover::orbital {

struct CostConfig {
  double clearance_m = 3.0;      // between the path and cells that are obstacles or unknown
  double risk_distance_m = 6.0;  // within it of such a cell a metre costs more ...
  double risk_cost = 1.0;        // ... up to this share, at the clearance
  double difficulty_cost = 1.0;  // added where the difficulty is 1
};

// Slope costs 10, 15, 25, 40 at 0, 5, 10 and 15 deg (HDPR), here over that of level ground.
double slope_cost(double slope_rad);

struct CostMap {
  MarchGrid grid;                           // cost per metre
  std::vector<double> obstacle_distance_m;  // to the nearest cell that is an obstacle or unknown, or beyond the border
};
CostMap travel_cost(const TerrainLayers& layers, const CostConfig& config);

}  // namespace rover::orbital
