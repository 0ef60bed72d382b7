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

// 1 for the obstacles that pass under the body, between the wheels. An obstacle as a whole is low or not.
std::vector<std::uint8_t> find_low_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                             const std::vector<std::uint8_t>& obstacle,
                                             const TraversabilityConfig& config);

// Marks regions of seen ground as obstacle if obstacles enclose them and they are smaller than the footprint.
void fill_enclosed_regions(const TerrainGrid& grid, double footprint_m2, std::vector<std::uint8_t>& obstacle);

}  // namespace rover::trav
