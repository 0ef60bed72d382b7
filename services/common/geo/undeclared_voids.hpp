// Detects voids that a file does not declare, by height steps between neighbouring pixels that terrain cannot have.
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
  std::vector<Plateau> plateaus;  // one exact height, with impossible steps along nearly all of its border
  std::int64_t interpolated = 0;  // pixels of small regions beside such steps: interpolated between ground and void
  std::string problem;            // one line; not empty if ground and void cannot be distinguished
};

// Sets them to NaN. `pixel_m`: pixel size on the ground. Row 0 of the raster is the last line of the file.
UndeclaredVoids remove_undeclared_voids(ElevationRaster& raster, double pixel_m);

}  // namespace rover
