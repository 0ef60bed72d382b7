// Horizon map: margin of the sun above the local horizon per vertex. Its interpolated zero line is the shadow edge, so
// no shadow rays are needed (the sun is fixed during a run).
#pragma once

#include <vector>

#include "rover_simulator/camera/ground_appearance.hpp"
#include "rover_simulator/camera/ground_tile.hpp"

namespace rover {

// (cells + 1)^2 margins. Shadow length is limited to one tile.
std::vector<float> sun_margins(const GroundTile::Heights& heights, const GroundAppearanceConfig& sun);

}  // namespace rover
