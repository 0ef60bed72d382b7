// Reads an elevation model through GDAL.
#pragma once

#include <stdexcept>
#include <string>

#include "rover_simulator/world/elevation_raster.hpp"

namespace rover {

// One line: the file and what is wrong with it.
class DtmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Voids { kRefuse, kAsNaN };

// Heights as the file has them. Throws DtmError where the file is missing, cut short, without georeference, not
// north-up with square pixels, or has voids that are refused.
ElevationRaster read_elevation(const std::string& file, Voids voids = Voids::kRefuse);

}  // namespace rover
