// The path that is being driven: a plan, which leads on to the global path.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "path_planner/expected_motion.hpp"
#include "path_planner/search/plan.hpp"

namespace rover::planning {

// kBacktrack: back along the driven track; kContinuous: of the Full level.
enum class PathKind : std::int8_t { kGlobal = 0, kRepair = 1, kContinuous = 2, kBacktrack = 3 };

struct LocalPath {
  std::int64_t id = -1;
  PathKind kind = PathKind::kGlobal;
  double corridor_half_width_m = 0.0;
  double goal_tolerance_m = 0.0;
  std::vector<RoutePoint> points;  // in odom
  std::vector<Zone> zones;         // in odom
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
  // Where the rover was when it got the path.
  const Pose2& planned_from() const { return planned_from_; }
  PathSegment segment() const { return route_.segment_at(progress_m_); }
  // Of the planned part of the route that is ahead; the rest is the global path.
  double planned_m() const { return plan_end_m_ - progress_m_; }

  void clear() { *this = ActivePath(); }
  // The whole path becomes this route, which nothing was planned of.
  void set_route(std::int64_t id, PathKind kind, Route route, double corridor_half_width_m, const Pose2& rover);
  // A plan that begins at the rover, or `behind` it, followed by `tail`.
  void set_plan(std::int64_t id, PathKind kind, std::vector<PlanPose> plan, const std::vector<RoutePoint>& tail,
                double corridor_half_width_m, std::int8_t level, const Pose2& rover);
  void follow(const Pose2& rover, double forward_mps);
  // From a checkpoint; the plan is not kept, only the path made from it.
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

  // Where a plan may begin that keeps the next `committed_m` of the path; later if a point turn lies there, earlier if
  // a cusp does.
  Start start_after(double committed_m) const;
  // The plan from there on, and the way there from a little behind the rover, as they will be driven; empty if there is
  // no plan.
  std::vector<PlanPose> plan_from(double at_m, const ExpectedMotion& motion) const;
  std::vector<PlanPose> plan_until(double at_m, const ExpectedMotion& motion) const;
  // Poses from which the LocCam looks on the way there.
  std::vector<Pose2> views_until(double at_m) const;

 private:
  Route route_;
  std::int64_t id_ = -1;
  PathKind kind_ = PathKind::kGlobal;
  double corridor_half_width_m_ = 0.0;
  Pose2 planned_from_;
  double progress_m_ = 0.0;
  double plan_end_m_ = 0.0;
  std::vector<PlanPose> plan_;
};

}  // namespace rover::planning
