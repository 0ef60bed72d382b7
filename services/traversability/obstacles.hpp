// Which cells belong to a rock, a step or a hole: its raised cells, its foot, and ground that it closes in.
#pragma once

#include <cstdint>
#include <vector>

#include "traversability/steps.hpp"
#include "traversability/terrain_grid.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

// 1 for each cell of an obstacle. The rover's size is not in it: the planner tests the exact footprint.
std::vector<std::uint8_t> find_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                         const TraversabilityConfig& config);

// Seen ground in pieces that obstacles alone enclose and that are too small for the rover becomes obstacle.
void close_islands(const TerrainGrid& grid, double footprint_m2, std::vector<std::uint8_t>& obstacle);

}  // namespace rover::trav
