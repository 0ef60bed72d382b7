// The tracks of a run: what the rover believed, what was true, and the paths; as TUM trajectories and as GeoJSON.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover::interchange {

struct StampedPose {
  Utime utime = kNever;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
};
using Trajectory = std::vector<StampedPose>;

// A line in the map, by its place along it.
struct Path {
  std::int64_t id = 0;
  Utime utime = kNever;
  std::vector<Eigen::Vector2d> points;
};

struct Tracks {
  Trajectory truth;     // T_map_body
  Trajectory estimate;  // T_map_body
  Trajectory odometry;  // T_odom_body
  std::vector<Path> global_paths;
};

// Lines "time x y z qx qy qz qw" as evo reads them, time in seconds.
void write_tum(std::ostream& out, const Trajectory& trajectory);

// Longitude and latitude [deg] of a place in the map.
using ToLonLat = std::function<Eigen::Vector2d(const Eigen::Vector2d& map_m)>;

// One LineString for each track, thinned to `step_m`. Without `to_lon_lat` the coordinates are metres of the map, and a
// property of each feature says so.
std::string geojson(const Tracks& tracks, const ToLonLat& to_lon_lat, double step_m);

}  // namespace rover::interchange
