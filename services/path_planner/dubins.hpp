// Shortest paths of an arc, a straight line and an arc between two poses (Dubins 1957; the four words LSL, RSR, LSR,
// RSL in the normalised form of Shkel and Lumelsky, 2001).
#pragma once

#include <array>
#include <optional>

#include "path_planner/geometry.hpp"

namespace rover::planning {

struct ArcSegment {
  double curvature_per_m = 0.0;
  double length_m = 0.0;
};

struct DubinsPath {
  std::array<ArcSegment, 3> segments;
  double length_m() const { return segments[0].length_m + segments[1].length_m + segments[2].length_m; }
};

// Nothing where none of the four words joins the poses.
std::optional<DubinsPath> dubins_path(const Pose2& from, const Pose2& to, double radius_m);

}  // namespace rover::planning
