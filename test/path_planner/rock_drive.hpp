// A rover with imperfect odometry that follows the planner's paths by arcs and point turns through a field of rocks, as
// trajectory_control and supervisor would let it: closes the loop around the planner.
#pragma once

#include <string>
#include <vector>

#include "test/path_planner/nav_view.hpp"
#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {

struct DriveConfig {
  PathPlannerConfig planner;
  CameraModel camera;
  bool full = false;  // the Full level: maps of the NavCam, and continuous planning
  NavCameraModel nav_camera;
  double nav_step_m = 0.5;
  double nav_turn_rad = 0.21;
  Utime nav_latency_us = 600'000;
  double odometry_drift = 0.01;  // deviation of the scale; 0.02 of it is the curvature that is not felt [1/m]
  Utime step_us = 100'000;
  Utime frame_us = 400'000;
  Utime frame_latency_us = 240'000;
  double speed_mps = 0.2;
  double turn_rate_radps = 0.2;
  double turn_overhead_s = 8.0;   // steering to the point turn and back
  double stop_distance_m = 0.25;  // as the supervisor
  double no_path_s = 20.0;        // then the drive is given up
  double timeout_s = 1500.0;
  std::vector<Zone> zones;
};

struct DriveResult {
  bool reached = false;
  bool collided = false;
  double driven_m = 0.0;
  double duration_s = 0.0;
  int replans = 0;
  int back_ups = 0;
  int point_turns = 0;
  int stops = 0;
  int hazard_stops = 0;  // of them before hazards, not unseen ground
  int paths = 0;
  double plan_p99_s = 0.0;  // CPU time of the planner's steps that published a path
  double stopped_s = 0.0;
  double min_clearance_m = kInfinity;  // footprint to rocks
  double zone_depth_m = 0.0;           // largest, of the footprint at the estimated pose in forbidden ground
  std::string text;                    // why it ended where it did
  std::vector<Pose2> track;            // true, in map
};

// Up to `count` keep-outs of random shape around the path, none of which covers start or goal.
std::vector<Zone> random_zones(const std::vector<Point2>& path, int count, std::uint64_t seed);

DriveResult drive(const DriveConfig& config, const std::vector<Rock>& rocks, const std::vector<Point2>& path,
                  std::uint64_t seed);

}  // namespace rover::planning::testing_support
