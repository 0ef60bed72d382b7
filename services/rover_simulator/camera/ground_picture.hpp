// The ground from straight above: the radiance that the cameras see, without a camera.
#pragma once

#include "common/geo/elevation_raster.hpp"
#include "rover_simulator/camera/ground_appearance.hpp"

namespace rover {

inline constexpr double kPictureSampleM = 0.1;  // the shadows and slopes of larger features

// Samples of kPictureSampleM over a rectangle at the map's origin; z_m is the radiance, 1 for a white surface under a
// sun in the zenith. The same on any number of threads.
ElevationRaster ground_picture(const Surface& surface, const GroundAppearanceConfig& appearance, double width_m,
                               double length_m, int threads);

}  // namespace rover
