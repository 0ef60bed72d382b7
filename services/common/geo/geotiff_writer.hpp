// Writes an elevation raster as a GeoTIFF.
#pragma once

#include <string>

#include "common/geo/elevation_raster.hpp"

namespace rover {

// NaN is its no-data value. Throws DtmError (elevation_map.hpp) if the file cannot be written.
void write_geotiff(const std::string& file, const ElevationRaster& raster);

}  // namespace rover
