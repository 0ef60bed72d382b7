// Keep-out and keep-in zones: polygons that come with a path. Every point of the footprint must stay outside of each
// keep-out and, if there are keep-ins, inside one of them.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "common/core/frames.hpp"

namespace rover {

struct Zone {
  std::string name;
  bool keep_in = false;
  std::vector<Eigen::Vector2d> points;  // corners, in the frame of the path; the last one is joined to the first
};

constexpr size_t kMaxZones = 100;
constexpr size_t kMaxZoneCorners = 1000;  // of all zones: each is tested many times a second

// Why these are no zones; empty if they are: named once each, three or more finite corners that enclose an area.
std::string zones_problem(const std::vector<Zone>& zones);
// The zone that forbids the point; null if none does.
const Zone* forbidding_zone(const std::vector<Zone>& zones, const Eigen::Vector2d& p);
// How far the rectangle about the pose reaches into forbidden ground, to 0.1 m; 0 if it does not.
double forbidden_depth_m(const std::vector<Zone>& zones, const Pose2& pose, double half_length_m, double half_width_m);

}  // namespace rover
