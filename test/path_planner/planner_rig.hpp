// A planner with a rover that is where its path says, without error: for tests that want one thing to happen.
#pragma once

#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {

class PlannerRig {
 public:
  static constexpr Utime kStepUs = 100'000;

  explicit PlannerRig(const PathPlannerConfig& config = planner_config()) : planner(config, 1) {
    planner.set_start_area({0.0, 0.0}, 2.0, 0);
  }

  std::string send_path(const std::vector<Point2>& points, std::int64_t id = 7) {
    GlobalPath path{id, {}, 0.75, 0.5};
    for (const Point2& p : points) path.points.push_back({p, kNaN, 0});
    return planner.set_global_path(path);
  }

  PoseSample sample() const {
    PoseSample s;
    s.utime = now;
    s.usable = true;
    s.T_odom_body = from_planar(odom);
    s.T_map_odom = from_planar(T_map_odom);
    s.position_variance_m2 = 0.0;
    s.forward_mps = forward_mps;
    s.travelled_m = travelled_m;
    return s;
  }

  PlannerOutput step() {
    now += kStepUs;
    planner.add_pose(sample());
    return step_without_pose();
  }
  PlannerOutput step_without_pose() {
    const PlannerOutput out = planner.step(now);
    if (out.path) paths.push_back(*out.path);
    return out;
  }

  // A frame of what the camera sees from here, taken at once.
  PlannerOutput look(int times = 1) {
    PlannerOutput out;
    for (int i = 0; i < times; ++i) {
      now += kStepUs;
      planner.add_pose(sample());
      planner.add_hazards(observe(camera, rocks, odom, now, random));
      out = step_without_pose();
    }
    return out;
  }

  // Along the newest path at 0.2 m/s with a frame every step; ends sooner where the planner says that it is blocked.
  PlannerOutput go(double way_m) {
    PlannerOutput out;
    for (double gone = 0.0; gone < way_m; gone += 0.08) {
      const Route route(paths.back().points);
      odom = route.pose_at(std::min(route.closest(position(odom)) + 0.08, route.length_m()));
      travelled_m += 0.08;
      forward_mps = 0.2;
      out = look();
      if (out.status.blocked_in_m < 0.3) break;
    }
    forward_mps = 0.0;
    return out;
  }

  PathPlanner planner;
  CameraModel camera;
  std::vector<Rock> rocks;  // in odom
  Pose2 odom;
  Pose2 T_map_odom;
  double forward_mps = 0.0;
  double travelled_m = 0.0;
  Utime now = 0;
  std::mt19937_64 random{1};
  std::vector<LocalPath> paths;  // as they were published
};

// The least distance of the rover's rectangle to the rocks if it follows the path.
inline double clearance_along_m(const LocalPath& path, const std::vector<Rock>& rocks) {
  const Route route(path.points);
  double least = kInfinity;
  for (double s = 0.0; s <= route.length_m(); s += 0.05)
    least = std::min(least, clearance_m(planner_config().footprint, route.pose_at(s), rocks));
  return least;
}

}  // namespace rover::planning::testing_support
