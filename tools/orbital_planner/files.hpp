// Output files of a plan.
#pragma once

#include <string>

#include "common/geo/elevation_map.hpp"
#include "common/geo/geography.hpp"
#include "tools/orbital_planner/config.hpp"
#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

// map.tif (if converted), path.geojson (metres for a map without planet), path.lcm, path.yaml, path.png, terrain.tif.
// Throws ConfigError.
void write_files(const std::string& dir, const ElevationMap& map, const Geography& geography, const Plan& plan,
                 const Line& waypoints, const PathTerms& terms);

}  // namespace rover::orbital
