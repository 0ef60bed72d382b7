// A planner with a rover that follows its path without error.
#pragma once

#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {

class PlannerRig {
 public:
  static constexpr Utime kStepUs = 100'000;
  static constexpr double kStepM = 0.08;

  explicit PlannerRig(std::shared_ptr<Background> background = std::make_shared<AtOnce>())
      : planner(planner_config(), 1, std::move(background)) {
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
    s.T_odom_ground = from_planar(odom);
    s.T_map_odom = from_planar(T_map_odom);
    s.forward_mps = forward_mps;
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

  // Along the active path at 0.2 m/s with a frame every step, until it is blocked.
  PlannerOutput go(double distance_m) {
    PlannerOutput out;
    for (double gone_m = 0.0; gone_m < distance_m; gone_m += kStepM) {
      const ActivePath& active = planner.active_path();
      odom = active.route().pose_at(std::min(active.progress_m() + kStepM, active.route().length_m()));
      forward_mps = active.segment().reverse ? -0.2 : 0.2;
      out = look();
      if (out.status.blocked_in_m < 0.3) break;
    }
    forward_mps = 0.0;
    return out;
  }
  // To the place without a frame, at the heading that the rover has.
  void move_to(double x_m, double y_m) {
    const Pose2 from = odom;
    const int steps = 1 + static_cast<int>(std::hypot(x_m - from.x_m, y_m - from.y_m) / 0.05);
    forward_mps = 0.1;
    for (int i = 1; i <= steps; ++i) {
      odom.x_m = from.x_m + (x_m - from.x_m) * i / steps;
      odom.y_m = from.y_m + (y_m - from.y_m) * i / steps;
      step();
    }
    forward_mps = 0.0;
  }

  PathPlanner planner;
  CameraModel camera;
  std::vector<Rock> rocks;  // in odom
  Pose2 odom;
  Pose2 T_map_odom;
  double forward_mps = 0.0;
  Utime now = 0;
  std::mt19937_64 random{1};
  std::vector<LocalPath> paths;  // as they were published
};

// Smallest distance of the footprint to the rocks along the path.
inline double clearance_along_m(const LocalPath& path, const std::vector<Rock>& rocks) {
  const Route route(path.points);
  double least = kInfinity;
  for (double s = 0.0; s <= route.length_m(); s += 0.05)
    least = std::min(least, clearance_m(planner_config().footprint, route.pose_at(s), rocks));
  return least;
}

}  // namespace rover::planning::testing_support
