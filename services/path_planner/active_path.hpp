// The path that is being driven: a plan split where the rover changes between forward and reverse. One segment is
// published at a time; the last one leads on to the global path.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "path_planner/search/plan.hpp"

namespace rover::planning {

// kBacktrack: driven in reverse; kContinuous: of the Full level.
enum class PathKind : std::int8_t { kGlobal = 0, kRepair = 1, kBacktrack = 2, kContinuous = 3 };

struct LocalPath {
  std::int64_t id = -1;
  PathKind kind = PathKind::kGlobal;
  double corridor_half_width_m = 0.0;
  double goal_tolerance_m = 0.0;
  std::vector<RoutePoint> points;  // in odom
};

class ActivePath {
 public:
  struct Start {
    Pose2 pose;
    double curvature_per_m = 0.0;
    bool reverse = false;
    double at_m = 0.0;  // along the route; NaN: off the path
  };

  bool empty() const { return route_.empty(); }
  std::int64_t id() const { return id_; }
  PathKind kind() const { return kind_; }
  const Route& route() const { return route_; }
  double progress_m() const { return progress_m_; }
  double remaining_m() const { return route_.length_m() - progress_m_; }
  double corridor_half_width_m() const { return corridor_half_width_m_; }
  bool reverse() const { return kind_ == PathKind::kBacktrack; }
  // Whether further segments follow the one that is being driven.
  bool has_next() const { return next_ < plan_.size(); }
  // Of the planned part of the route that is ahead; the rest is the global path.
  double planned_m() const { return plan_end_m_ - progress_m_; }

  void clear() { *this = ActivePath(); }
  // The whole path becomes this route, which nothing was planned of.
  void set_route(std::int64_t id, PathKind kind, Route route, double corridor_half_width_m, Point2 rover);
  // A plan that begins at the rover, or `behind` it, followed by `tail`.
  void set_plan(std::int64_t id, PathKind forward_kind, std::vector<PlanPose> plan, std::vector<RoutePoint> tail,
                double corridor_half_width_m, std::int8_t level, Point2 rover);
  // The next segment.
  void advance(std::int64_t id, Point2 rover);
  void follow(Point2 rover);
  // From a checkpoint: the segment that was being driven.
  void restore(std::int64_t id, PathKind kind, Route route, double corridor_half_width_m, double progress_m,
               double planned_m) {
    set_route(id, kind, std::move(route), corridor_half_width_m, {});
    progress_m_ = progress_m;
    plan_end_m_ = progress_m + planned_m;
  }
  // The same path with its global part moved.
  void replace_route(std::int64_t id, Route route) {
    id_ = id;
    route_ = std::move(route);
  }
  bool at_end(Point2 rover) const;

  // Body pose on the route.
  Pose2 pose_at(double s_m) const;
  // Where a plan may begin that keeps the next `committed_m` of the path; later if a point turn lies there.
  Start start_after(double committed_m) const;
  // The plan from there on; empty if there is none.
  std::vector<PlanPose> plan_from(double at_m) const;
  std::vector<PlanPose> plan_until(double at_m) const;

 private:
  void publish_segment(std::int64_t id, Point2 rover);

  Route route_;
  std::int64_t id_ = -1;
  PathKind kind_ = PathKind::kGlobal;
  PathKind forward_kind_ = PathKind::kGlobal;
  double corridor_half_width_m_ = 0.0;
  double progress_m_ = 0.0;
  double plan_end_m_ = 0.0;
  std::int8_t level_ = 0;
  std::vector<PlanPose> plan_;
  std::vector<RoutePoint> tail_;
  size_t begin_ = 0;  // in plan_: the segment that is being driven
  size_t next_ = 0;   // and the one after it
};

}  // namespace rover::planning
