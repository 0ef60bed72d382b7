// Writes an elevation raster as a GeoTIFF.
#pragma once

#include <string>

#include "rover_simulator/world/elevation_raster.hpp"

namespace rover {

// Throws DtmError (dtm_reader.hpp) where the file cannot be written.
void write_geotiff(const std::string& file, const ElevationRaster& raster);

}  // namespace rover
