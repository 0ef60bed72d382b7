// The one reader of orbital maps and elevation models (DTMs): whatever a user's file is, what comes out is in metres.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/geo/elevation_raster.hpp"

namespace rover {

// One line: the file, what is wrong with it and what to do.
class DtmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ElevationMap {
  ElevationRaster raster;             // metres along the ground and upwards; NaN: void
  std::int64_t undeclared_voids = 0;  // pixels of the file that were taken for void though it does not say so
  bool converted = false;             // the file itself has other units, another projection or other directions
  std::vector<std::string> notes;  // for the user's terminal, a line each: what was converted, what was taken for void
};

// Any format of GDAL's with one band of heights and a georeference. A map that is not north-up, square and true to
// scale in metres (within 1 %) is reprojected to a stereographic projection about its middle, on its own body. Heights
// are scaled by the file's scale, offset and unit. Voids are what the file tags, and what no terrain can be
// (undeclared_voids.hpp). Throws DtmError alone.
ElevationMap read_elevation_map(const std::string& file);

// For users that need ground everywhere. Throws DtmError, which says how many heights are missing and where.
void demand_no_voids(const ElevationMap& map, const std::string& file);

}  // namespace rover
