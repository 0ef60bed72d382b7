// A picture of the world from orbit, on the ground that the orbital map shows.
#pragma once

#include "rover_simulator/camera/ground_appearance.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {

// z_m is the brightness from 0 to 255. With the blur and the distortion of the orbital map. `ground`: as the cameras
// see it; its sun is replaced.
ElevationRaster orbital_picture(const World& world, const OrbitalPictureConfig& config, GroundAppearanceConfig ground,
                                int threads);

}  // namespace rover
