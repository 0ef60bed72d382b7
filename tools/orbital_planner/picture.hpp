// The relief with the terrain's obstacles, and the path in the colours of its levels.
#pragma once

#include <opencv2/core.hpp>

#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

// BGR, north up, of the path's surroundings.
cv::Mat draw(const ElevationRaster& map, const Plan& plan, const Line& waypoints);

// Colours of the path.
cv::Scalar colour_of(Level level);

}  // namespace rover::orbital
