// A plan as the messages and texts that others read.
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

// RFC 7946, but on the map's own planet, or in whatever coordinates `to_lon_lat` gives: a line for each stretch with
// its level and figures, a point for each way-point.
using ToLonLat = std::function<Eigen::Vector2d(const Eigen::Vector2d& map_m)>;
std::string geojson_from(const Plan& plan, const Line& waypoints, const ToLonLat& to_lon_lat);

const char* name_of(Level level);

}  // namespace rover::orbital
