// Converts a plan to messages and text formats.
#pragma once

#include <functional>
#include <rover/path_t.hpp>
#include <string>

#include "tools/orbital_planner/orbital_planner.hpp"

namespace rover::orbital {

struct PathTerms {
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
};

// GLOBAL_PATH, without header times.
path_t message_from(const Plan& plan, const PathTerms& terms);

// The section `path:` of a scenario.
std::string yaml_from(const Plan& plan, const PathTerms& terms);

// Polygons of a GeoJSON text, in its coordinates; property kind: keep_out (also without one) or keep_in. Throws
// ConfigError that names the file.
std::vector<Zone> zones_from_geojson(const std::string& text, const std::string& file);

// RFC 7946 on the map's planet, or in the coordinates of `to_lon_lat`: a line per segment with level and metrics, a
// point per waypoint, a polygon per zone.
using ToLonLat = std::function<Eigen::Vector2d(const Eigen::Vector2d& map_m)>;
std::string geojson_from(const Plan& plan, const Line& waypoints, const ToLonLat& to_lon_lat);

const char* name_of(Level level);

}  // namespace rover::orbital
