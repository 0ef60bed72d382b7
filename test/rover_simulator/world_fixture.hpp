// Small worlds for the tests.
#pragma once

#include "rover_simulator/world/world.hpp"

namespace rover {

// Level, without roughness, zones and rocks.
inline WorldConfig bare_config() {
  WorldConfig config;
  config.rocks.k = 0.0;
  config.roughness.rms_m = 0.0;
  config.soil.everywhere = Soil::kFirm;
  return config;
}

inline ElevationRaster level_raster(double side_m) {
  return plane_raster(side_m, side_m, 1.0, 0.0, 0.0);
}

}  // namespace rover
