// Steps: rise of a cell above the lowest one within a wheel diameter, relative to the local slope. It must be
// significant compared with the noise of the two heights.
#pragma once

#include <vector>

#include "traversability/disc_planes.hpp"
#include "traversability/terrain_grid.hpp"

namespace rover::trav {

struct Steps {
  std::vector<float> rise_m;      // significant; 0: none
  std::vector<float> raw_rise_m;  // without the significance test
};

// Cells with a NaN height are ignored. `planes` give the local slope.
Steps find_steps(const TerrainGrid& grid, const DiscPlanes& planes, const StepConfig& config);

}  // namespace rover::trav
