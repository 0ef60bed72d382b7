// Estimated track, true track and paths of a run, as TUM trajectories and as GeoJSON.
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

// Polyline in map.
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

// Longitude and latitude [deg] of a map point.
using ToLonLat = std::function<Eigen::Vector2d(const Eigen::Vector2d& map_m)>;

// One LineString per track, decimated to `step_m`. Without `to_lon_lat`: map metres, stated in a property of each
// feature.
std::string geojson(const Tracks& tracks, const ToLonLat& to_lon_lat, double step_m);

}  // namespace rover::interchange
