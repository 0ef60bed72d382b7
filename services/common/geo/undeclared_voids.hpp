// Voids that a file does not declare. Terrain is connected: between neighbouring pixels it steps by kilometres nowhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/geo/elevation_raster.hpp"

namespace rover {

struct UndeclaredVoids {
  struct Plateau {
    float height_m = 0.0F;
    std::int64_t pixels = 0;
  };
  std::vector<Plateau> plateaus;  // one exact height, and nearly everywhere along its border a step that no terrain has
  std::int64_t rests = 0;         // pixels of small regions behind such steps: interpolation between ground and void
  std::string problem;            // not empty: it cannot be known what is ground; one line
};

// Sets them to NaN. `pixel_m`: the size of a pixel on the ground. Row 0 of the raster is the file's last line.
UndeclaredVoids remove_undeclared_voids(ElevationRaster& raster, double pixel_m);

}  // namespace rover
