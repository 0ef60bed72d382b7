// Ground on which local repairs are tried: a map that knows its hazards, a global path and a rover on it.
#pragma once

#include <vector>

#include "path_planner/local_repair.hpp"
#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {

struct RepairField {
  HazardMemory memory;
  Route route;
  double from_m = 0.0;
  Pose2 start;
  double start_curvature_per_m = 0.0;
  Pose2 stopped;
  double sure_m = kInfinity;
};

constexpr double kRepairMarginM = 0.17;
constexpr double kRepairGoalReachM = 0.3;

// A map of 10 x 10 m around the origin; all of it seen or nothing.
HazardMemory ground(bool seen);
// Every cell whose centre a hazardous rock covers becomes a confirmed hazard.
void lay_rocks(HazardMemory& memory, const std::vector<Rock>& rocks);
// A straight path along x, from 4 m behind the origin.
Route straight_route(double length_ahead_m);
// Rocks around a rover that follows a path past the origin, and one rock in its way.
RepairField random_field(std::uint64_t seed);
RepairResult plan_on(const RepairField& field, const Terrain& terrain, const LocalRepairConfig& config,
                     double goal_reach_m = kRepairGoalReachM);

}  // namespace rover::planning::testing_support
