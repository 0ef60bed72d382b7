// How far the sun stands above the local horizon, for each vertex of a tile: the shadow's edge is where this is zero,
// and that line is far finer than the lattice. The cameras then need no shadow rays (the sun stands still during a
// run).
#pragma once

#include <vector>

#include "rover_simulator/camera/ground_look.hpp"
#include "rover_simulator/camera/ground_tile.hpp"

namespace rover {

// (cells + 1)^2 margins. Shadows are as long as a tile at most.
std::vector<float> sun_margins(const GroundTile::Heights& heights, const GroundLookConfig& sun);

}  // namespace rover
