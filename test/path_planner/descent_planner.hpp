// The example of docs/contributing.md: a second planner in one file. It follows the descent of the 2-D cost-to-go, as
// the paper's repair does, and never reverses.
#pragma once

#include "path_planner/search/cost_to_go.hpp"
#include "path_planner/search/footprint_check.hpp"
#include "path_planner/search/planners.hpp"

namespace rover::planning::testing_support {

class DescentPlanner final : public Planner {
 public:
  explicit DescentPlanner(const HybridPlannerConfig& config) : config_(config) {}

  Plan plan(const PlanRequest& request) const override {
    const double margin_m = config_.clearances.turn_m;
    // Whatever its heading is: the whole circle around the rover keeps clear.
    const Footprint circle{config_.footprint.radius_m(), config_.footprint.radius_m(), 0.0};
    const CostToGo cost_to_go(config_.cost_to_go, request, circle, margin_m);
    const FootprintCheck check(*request.costmap, config_.footprint, margin_m, 0.0, 0.0, request.rover);
    Plan plan;
    plan.cost = cost_to_go.at(position(request.start));
    Pose2 pose = request.start;
    plan.poses.push_back({pose, false, 0.0});
    while (std::isinf(cost_to_go.goal_cost(position(pose))) &&
           distance(position(pose), position(request.start)) < config_.horizon_m) {
      const double turn_rad = wrap_angle(cost_to_go.descent_rad(position(pose)) - pose.yaw_rad);
      const bool on_the_spot = std::abs(turn_rad) > kPointTurnRad;
      if (on_the_spot) pose.yaw_rad += turn_rad;
      const double max_curvature = config_.motion.max_curvature_per_m;
      pose = on_the_spot ? pose : advanced(pose, kStepM, std::clamp(turn_rad / kStepM, -max_curvature, max_curvature));
      if (!check.clear(pose) || plan.poses.size() > kMaxPoses) return {};
      plan.poses.push_back({pose, false, 0.0});
    }
    plan.found = true;
    plan.clearance_m = margin_m;
    return plan;
  }

 private:
  static constexpr double kStepM = 0.05;
  static constexpr double kPointTurnRad = 0.8;
  static constexpr size_t kMaxPoses = 1000;

  HybridPlannerConfig config_;
};

}  // namespace rover::planning::testing_support
