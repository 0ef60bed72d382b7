// Picture of relief, obstacles, and the path in the colours of its levels.
#pragma once

#include <opencv2/core.hpp>

#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

// BGR image of the path's surroundings, north up.
cv::Mat draw(const ElevationRaster& map, const Plan& plan, const Line& waypoints);

// Colours of the path.
cv::Scalar colour_of(Level level);

}  // namespace rover::orbital
