// The shortest path that the rover could drive if it knew the true surface: the reference of a drive's length.
#pragma once

#include "common/core/vehicle.hpp"
#include "tools/oracle/cost_to_go.hpp"

namespace rover::oracle {

struct Request {
  HeightFunction height_m;
  HeightFunction ground_m;   // without rocks
  double map_width_m = 0.0;  // the map's extent; the path stays on it
  double map_length_m = 0.0;
  Vehicle vehicle;
  Pose2 start;
  Points planned;  // global path; ends at the goal
  double goal_tolerance_m = 0.5;
  double corridor_half_width_m = 1.5;
  std::vector<Zone> zones;
  int max_expansions = 3'600'000;  // of all regions together: at most about 20 s
};

enum class Status {
  kFound,
  kStartBlocked,  // the rover does not fit where it starts
  kNoPath,        // the region was searched completely
  kGaveUp         // the limit of the search was reached
};
std::string status_text(Status status);

struct Result {
  Status status = Status::kNoPath;
  double length_m = kNaN;
  Pieces path;
  int expansions = 0;
};

Result shortest_path(const Request& request);

// Points along the path, at most this far apart.
Points points_of(const Pieces& path, double step_m);

}  // namespace rover::oracle
