#include "tools/interchange/tracks.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace rover::interchange {
namespace {

using json = nlohmann::ordered_json;

std::vector<Eigen::Vector2d> thinned(const Trajectory& trajectory, double step_m) {
  std::vector<Eigen::Vector2d> points;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector2d p = pose.T.translation().head<2>();
    const bool last = &pose == &trajectory.back();
    if (points.empty() || last || (p - points.back()).norm() >= step_m) points.push_back(p);
  }
  // A line needs two points.
  if (points.size() == 1) points.push_back(points.front());
  return points;
}

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

json feature(const std::string& track, const std::vector<Eigen::Vector2d>& points, const ToLonLat& to_lon_lat) {
  json coordinates = json::array();
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d place = to_lon_lat ? to_lon_lat(p) : p;
    const double unit = to_lon_lat ? 1e-9 : 1e-4;
    coordinates.push_back({rounded(place.x(), unit), rounded(place.y(), unit)});
  }
  return {{"type", "Feature"},
          {"properties", {{"track", track}, {"coordinates", to_lon_lat ? "longitude, latitude" : "map, metres"}}},
          {"geometry", {{"type", "LineString"}, {"coordinates", coordinates}}}};
}

}  // namespace

void write_tum(std::ostream& out, const Trajectory& trajectory) {
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d p = pose.T.translation();
    const Eigen::Quaterniond q(pose.T.linear());
    char line[256];
    std::snprintf(line, sizeof line, "%.6f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", to_seconds(pose.utime), p.x(), p.y(),
                  p.z(), q.x(), q.y(), q.z(), q.w());
    out << line;
  }
}

std::string geojson(const Tracks& tracks, const ToLonLat& to_lon_lat, double step_m) {
  json features = json::array();
  if (!tracks.truth.empty()) features.push_back(feature("truth", thinned(tracks.truth, step_m), to_lon_lat));
  if (!tracks.estimate.empty()) features.push_back(feature("estimate", thinned(tracks.estimate, step_m), to_lon_lat));
  for (const Path& path : tracks.global_paths) {
    json line = feature("global_path", path.points, to_lon_lat);
    line["properties"]["path_id"] = path.id;
    features.push_back(std::move(line));
  }
  return json{{"type", "FeatureCollection"}, {"features", features}}.dump(1) + "\n";
}

}  // namespace rover::interchange
