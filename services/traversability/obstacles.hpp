// Segments obstacles (rocks, steps, holes): their raised cells, and ground that they enclose.
#pragma once

#include <cstdint>
#include <vector>

#include "traversability/steps.hpp"
#include "traversability/terrain_grid.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

// 1 for obstacle cells, without inflation: the planner checks the exact footprint.
std::vector<std::uint8_t> find_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                         const TraversabilityConfig& config);

// Marks regions of seen ground as obstacle if obstacles enclose them and they are smaller than the footprint.
void fill_enclosed_regions(const TerrainGrid& grid, double footprint_m2, std::vector<std::uint8_t>& obstacle);

}  // namespace rover::trav
