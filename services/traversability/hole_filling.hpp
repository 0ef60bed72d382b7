// Fills holes of one or two cells in even ground from their neighbours. Larger holes, and those between neighbours of
// different height (occlusion behind a rock), stay unknown: not seen is not safe.
#pragma once

#include "traversability/terrain_grid.hpp"

namespace rover::trav {

// Also sets cells with an invalid value or a sigma above max_sigma_m to NaN. `max_height_difference_m`: largest height
// difference among the neighbours of a filled hole.
void fill_small_holes(TerrainGrid& grid, double max_sigma_m, double max_height_difference_m);

}  // namespace rover::trav
