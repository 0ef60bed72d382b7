// Cost per metre in each cell: 1 on level, smooth ground; infinity if not traversable.
#pragma once

#include <vector>

#include "common/core/fast_marching.hpp"
#include "common/core/zones.hpp"
#include "tools/orbital_planner/terrain.hpp"

namespace rover::orbital {

struct CostConfig {
  double clearance_m = 3.0;      // minimum distance of the path to obstacles and unknown cells
  double risk_distance_m = 6.0;  // the cost rises within this distance of such a cell ...
  double risk_cost = 1.0;        // ... by this much at the clearance
  double difficulty_cost = 1.0;  // cost added at difficulty 1
};

// HDPR's slope costs 10, 15, 25, 40 at 0, 5, 10 and 15 deg, relative to level ground.
double slope_cost(double slope_rad);

struct CostMap {
  MarchGrid grid;                           // cost per metre
  std::vector<double> obstacle_distance_m;  // to the nearest obstacle, unknown cell, forbidden cell or map border
};
CostMap travel_cost(const TerrainLayers& layers, const CostConfig& config, const std::vector<Zone>& zones = {});

}  // namespace rover::orbital
