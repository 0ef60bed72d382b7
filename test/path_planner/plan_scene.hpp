// Ground that is known for certain, and requests for a plan across it.
#pragma once

#include <functional>

#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {

enum class Ground : std::uint8_t { kFree, kHazard, kUnknown };
using GroundAt = std::function<Ground(Point2)>;

// A belief map around the origin.
BeliefMap certain_belief(const GroundAt& ground);
// Heights of the ground, as the NavCam's map gives them.
void set_heights(BeliefMap& belief, const std::function<double(Point2)>& height_m);
// Height on a plane that rises with y.
double side_slope(double deg, Point2 p);
// Free ground, but where a hazardous rock covers it.
GroundAt ground_of(std::vector<Rock> rocks);
// Rocks of random size and density, none of them near the origin.
std::vector<Rock> random_rocks(std::uint64_t seed);
// A plan from the pose, where the rover is, to the end of the global path.
PlanRequest plan_request(const BeliefMap& belief, const Pose2& start = {},
                         const std::vector<Point2>& global_path = {{-3.0, 0.0}, {30.0, 0.0}});
HybridPlannerConfig search_config();

}  // namespace rover::planning::testing_support
