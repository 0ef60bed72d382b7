// Reads orbital maps and elevation models (DTMs) and converts them to metres.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/geo/elevation_raster.hpp"

namespace rover {

// One line: file, error and remedy.
class DtmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ElevationMap {
  ElevationRaster raster;             // NaN: void
  std::int64_t undeclared_voids = 0;  // pixels treated as void without a declaration in the file
  bool converted = false;             // the file has other units, projection or orientation
  std::vector<std::string> notes;     // one line each, for the user: conversions and undeclared voids
};

// Accepts any GDAL format with one band of heights and a georeference. A map that is not north-up with square pixels in
// true metres (within 1 %) is reprojected to a stereographic projection about its centre. Heights are scaled by the
// file's scale, offset and unit. Voids are declared by the file or detected (undeclared_voids.hpp). Throws only
// DtmError.
ElevationMap read_elevation_map(const std::string& file);

// Brightness (mean of the colours) in pixels of the picture's size over the map's ground, in the map's projection; NaN
// where it shows none. Any GDAL format with a georeference. Throws DtmError, also if it shows nothing of the map.
ElevationRaster read_picture(const std::string& file, const ElevationRaster& map);

// Larger maps are refused; they can be read in parts (elevation_map_file.hpp).
constexpr std::int64_t kMaxPixelsInMemory = 40'000'000;

// Throws DtmError.
bool is_large_map(const std::string& file, std::int64_t max_pixels = kMaxPixelsInMemory);

// Throws DtmError with the number and place of missing heights.
void require_no_voids(const ElevationMap& map, const std::string& file);

}  // namespace rover
