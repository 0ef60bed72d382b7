// A flat field of rocks by the size-frequency law and a camera that sees it: just enough of a world for the planner.
#pragma once

#include <cstdint>
#include <vector>

#include "path_planner/path_planner.hpp"
#include "test/path_planner/randoms.hpp"

namespace rover::planning::testing_support {

struct Rock {
  Point2 p;
  double radius_m = 0.0;
  double height_m = 0.0;
};

constexpr double kHazardHeightM = 0.15;  // lower rocks are driven over
constexpr double kBodyHeightM = 0.20;    // the body passes over lower ones

// Golombek's law F(D) = k exp(-q D), q = 1.79 + 0.152 / k, for rocks of at least `min_diameter_m`; height D / 2.
std::vector<Rock> rock_field(double k, Point2 low, Point2 high, double min_diameter_m, std::mt19937_64& random);

struct CameraModel {
  Point2 position{0.527, 0.074};  // in body
  double height_m = 0.68;
  double pitch_rad = 0.576;  // down
  double tangent = 0.60;     // of the half field of view
  double baseline_m = 0.12;  // the right camera does not see the left edge
  double near_m = 0.97;      // from the body origin
  double far_m = 4.0;
  double false_hit_rate = 0.0;  // single false cells per frame
};

// The frame that hazard_detector would send, seen from the true pose.
HazardGrid observe(const CameraModel& camera, const std::vector<Rock>& rocks, const Pose2& pose, Utime utime,
                   std::mt19937_64& random);

// From the footprint, or over low rocks the wheels, to the nearest rock that is a hazard, negative inside; infinity: no
// rock within 3 m.
double clearance_m(const Footprint& footprint, const Pose2& pose, const std::vector<Rock>& rocks);

// On level ground, where all cost is that of steps.
void complete(TraversabilityGrid& map);

// The configuration that the service ships, without its file.
PathPlannerConfig planner_config();

}  // namespace rover::planning::testing_support
