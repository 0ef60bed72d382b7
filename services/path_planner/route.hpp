// A path in the plane, measured by its arc length.
#pragma once

#include <cstdint>
#include <vector>

#include "path_planner/geometry.hpp"

namespace rover::planning {

struct RoutePoint {
  Point2 p;
  double global_s_m = kNaN;  // along the global path; NaN: on a repair
  std::int8_t level = 0;     // wanted from here on (path_t)
  bool reverse = false;      // motion from here on
};

// Part of a route between two places where the rover stops: for a point turn or to change its direction.
struct PathSegment {
  double begin_m = 0.0;
  double end_m = 0.0;
  bool reverse = false;
};

class Route {
 public:
  Route() = default;
  explicit Route(std::vector<RoutePoint> points);

  bool empty() const { return points_.empty(); }
  const std::vector<RoutePoint>& points() const { return points_; }
  double length_m() const { return s_m_.empty() ? 0.0 : s_m_.back(); }
  double s_at(size_t i) const { return s_m_[i]; }
  // Sharper bends between two pieces are corners, as of trajectory_control.
  static constexpr double kCornerRad = to_rad(40.0);

  // Body pose on the polyline; the heading changes evenly between vertices, and jumps at corners (after the jump
  // there).
  Pose2 pose_at(double s_m) const;
  // Vertices at which the heading jumps: the rover turns there on the spot.
  const std::vector<size_t>& corners() const { return corners_; }
  double yaw_into(size_t i) const { return yaw_in_rad_[i]; }
  double yaw_out_of(size_t i) const { return yaw_out_rad_[i]; }
  Point2 point_at(double s_m) const;
  std::int8_t level_at(double s_m) const;
  bool reverse_at(double s_m) const;
  // A corner or cusp belongs to the segment that follows it.
  PathSegment segment_at(double s_m) const;
  // Arc length of the closest point with arc length in [from, to].
  double closest(Point2 p, double from_m, double to_m) const;
  double closest(Point2 p) const { return closest(p, 0.0, length_m()); }
  // First vertex with arc length above s.
  size_t vertex_after(double s_m) const;

 private:
  void set_headings();
  bool stops_at(size_t i) const;  // at an inner vertex

  std::vector<RoutePoint> points_;
  std::vector<double> s_m_;
  std::vector<double> yaw_in_rad_;  // continuous along the route, but at corners
  std::vector<double> yaw_out_rad_;
  std::vector<size_t> corners_;
};

// The route seen from another frame.
Route transformed(const Route& route, const Pose2& T);
// Points at steps of `step_m`, corners rounded with a radius of at least `min_radius_m` and at most `max_radius_m`
// where that keeps within `tolerance_m` of the corner; sharper ones stay, for a point turn.
struct RoundingConfig {
  double step_m = 0.1;
  double min_radius_m = 1.0;
  double max_radius_m = 4.0;
  double tolerance_m = 0.2;
};
Route rounded(const std::vector<RoutePoint>& corners, const RoundingConfig& config);

}  // namespace rover::planning
