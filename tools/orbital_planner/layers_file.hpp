// Writes the terrain layers as a GeoTIFF with one band each.
#pragma once

#include <string>

#include "tools/orbital_planner/terrain.hpp"

namespace rover::orbital {

// Throws DtmError if the file cannot be written.
void write_layers(const std::string& file, const ElevationRaster& map, const TerrainLayers& layers);

}  // namespace rover::orbital
