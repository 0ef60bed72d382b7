// Steps of the ground: how far a cell rises over the lowest one within a wheel's reach, and falls below its direct
// neighbours. Both are counted from the slope around, and only where they stand out of the noise of the two heights.
#pragma once

#include <vector>

#include "traversability/disc_planes.hpp"
#include "traversability/terrain_grid.hpp"

namespace rover::trav {

struct Steps {
  std::vector<float> rise_m;            // significant; 0: none
  std::vector<float> drop_m;            // significant, to a direct neighbour
  std::vector<float> uncertain_rise_m;  // whatever the noise
};

// Heights are NaN where nothing was seen; such cells take no part. `planes` give the slope around each cell.
Steps find_steps(const TerrainGrid& grid, const DiscPlanes& planes, const StepConfig& config);

}  // namespace rover::trav
