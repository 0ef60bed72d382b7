// A flat field of rocks by the size-frequency law, a camera that sees it, and a rover that follows a path exactly by
// arcs: just enough of a world to close the loop around the planner.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "path_planner/path_planner.hpp"

namespace rover::planning::testing {

struct Rock {
  Point2 p;
  double radius_m = 0.0;
  double height_m = 0.0;
};

// Golombek's law F(D) = k exp(-q D), q = 1.79 + 0.152 / k, for rocks of at least `least_diameter_m`; height D / 2.
std::vector<Rock> rock_field(double k, Point2 low, Point2 high, double least_diameter_m, std::mt19937_64& random);

struct CameraModel {
  Point2 position{0.527, 0.074};  // in body
  double height_m = 0.68;
  double pitch_rad = 0.576;       // down
  double tangent = 0.60;          // of the half field of view
  double baseline_m = 0.12;       // the right camera does not see the left edge
  double near_m = 0.97;           // from the body origin
  double far_m = 4.0;
  double false_hit_rate = 0.0;    // single false cells per frame
};

// The frame that hazard_detector would send, seen from the true pose.
HazardGrid observe(const CameraModel& camera, const std::vector<Rock>& rocks, const Pose2& pose, Utime utime,
                   std::mt19937_64& random);

struct DriveConfig {
  PathPlannerConfig planner;
  CameraModel camera;
  double odometry_drift = 0.01;   // deviation of the scale; 0.02 of it is the curvature that is not felt [1/m]
  Utime step_us = 100'000;
  Utime frame_us = 400'000;
  Utime frame_latency_us = 240'000;
  double speed_mps = 0.2;
  double turn_rate_radps = 0.2;
  double turn_overhead_s = 8.0;   // steering to the point turn and back
  double hazard_stop_m = 0.5;     // as the supervisor
  double unseen_stop_m = 0.25;
  double no_path_s = 20.0;        // then the drive is given up
  double timeout_s = 1500.0;
};

struct DriveResult {
  bool reached = false;
  bool collided = false;
  double driven_m = 0.0;
  double duration_s = 0.0;
  int replans = 0;
  int point_turns = 0;
  int stops = 0;
  double stopped_s = 0.0;
  double least_clearance_m = kInfinity;  // rectangle to rocks
  std::string text;
  std::vector<Pose2> track;
};

DriveResult drive(const DriveConfig& config, const std::vector<Rock>& rocks, const std::vector<Point2>& path,
                  std::uint64_t seed);

// The configuration that the service ships, without its file.
PathPlannerConfig planner_config();

}  // namespace rover::planning::testing
