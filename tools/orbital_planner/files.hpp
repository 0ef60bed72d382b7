// What a plan leaves behind in its folder.
#pragma once

#include <string>

#include "common/geo/elevation_map.hpp"
#include "common/geo/geography.hpp"
#include "tools/orbital_planner/config.hpp"
#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

// map.tif where the map was converted, path.geojson (in metres for a map on no planet), path.lcm (an LCM log with the
// one GLOBAL_PATH), path.yaml, path.png and terrain.tif (slope [deg], roughness [m], step [m], difficulty, class).
// Throws ConfigError with one line where one cannot be written.
void write_files(const std::string& dir, const ElevationMap& map, const Geography& geography, const Plan& plan,
                 const Line& waypoints, const PathTerms& terms);

}  // namespace rover::orbital
