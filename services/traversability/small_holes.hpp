// Holes of one or two cells inside well-seen, even ground are closed by their neighbours. Larger ones, and those
// between neighbours of different height (a rock's shadow), stay open: not seen is not safe.
#pragma once

#include "traversability/terrain_grid.hpp"

namespace rover::trav {

// Also makes every cell with a sigma beyond max_sigma_m, or with a value that is no number, NaN. `even_m`: the largest
// height difference of neighbours that close a hole.
void close_small_holes(TerrainGrid& grid, double max_sigma_m, double even_m);

}  // namespace rover::trav
