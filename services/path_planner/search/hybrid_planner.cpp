#include "path_planner/search/hybrid_planner.hpp"

namespace rover::planning {
namespace {

constexpr double kKnownMarginM = 0.04;  // the rover follows a path within centimetres
constexpr double kApproachM = 0.005;    // less than the path monitor's
constexpr double kMaxClearanceM = 1.5;
constexpr double kSlideOverM = 0.3;   // driven until the rover has steered against a slide
constexpr double kHorizonRimM = 1.0;  // of the costmap, beyond the farthest horizon
constexpr double kLedBackM = 1.5;     // from the start; the ground about the rover is driven
// The lattice first lets through what almost fits, and ends where its best path is much better than others. If that
// misleads the search, it holds only what surely fits, and all of it.
constexpr std::array<LatticeExtent, 2> kExtents = {LatticeExtent{0.03, 10.0}, LatticeExtent{-0.03, kInfinity}};

Plan kept(double cost, int expansions) {
  Plan plan;
  plan.keeps_incumbent = true;
  plan.cost = cost;
  plan.expansions = expansions;
  return plan;
}

bool leads_back(const Plan& plan, const PlanRequest& request) {
  return request.back_to.empty() && std::any_of(plan.poses.begin(), plan.poses.end(), [&](const PlanPose& at) {
           const Point2 p = position(at.pose);
           return distance(p, position(request.start)) > kLedBackM && request.costmap->passed(p);
         });
}

}  // namespace

Plan HybridPlanner::plan(const PlanRequest& request) const {
  Clearances margins = config_.clearances;
  if (!request.back_to.empty()) margins.min_m -= Clearances::kToleranceM;
  // The places of both fields are the same: where no pose of the lattice fits, no way of the 2-D field leads.
  const CostToGo cost_to_go(config_.cost_to_go, request, config_.footprint, margins.min_m - kExtents.front().slack_m);
  const auto check = [&](double margin_m) {
    FootprintCheck out(*request.costmap, config_.footprint, margin_m, kApproachM, kKnownMarginM, request.rover);
    out.allow_slide(kSlideOverM * std::abs(request.side_slip.at(request.rover.yaw_rad)));
    return out;
  };
  const FootprintCheck comfort = check(margins.comfort_m);
  const FootprintCheck min = check(margins.min_m);
  const FootprintCheck turn = check(margins.turn_m);
  const RollCheck roll(config_.roll, *request.costmap, config_.footprint, request.rover);
  PricedGround ground{request, cost_to_go, comfort, min, turn, roll, config_.view, config_.search.known_free_m};
  const double at_least = cost_to_go.at(position(request.start));
  const double driven = incumbent_cost(ground);
  // Hardly any path is cheaper than the 2-D field says, which knows no headings.
  if (std::isfinite(at_least) && driven <= at_least + config_.switching_cost_s) return kept(driven, 0);
  Plan plan = search(ground, margins, driven, config_.horizon_m);
  // The 2-D field may lead to places that the rover has found closed: it would go back and forth between two. The
  // lattice knows better, and reaches as far as the costmap then.
  if (leads_back(plan, request))
    plan = search(ground, margins, driven,
                  std::max(config_.horizon_m, request.costmap->inside_m(position(request.start)) - kHorizonRimM));
  if (!plan.found) return plan;
  plan.clearance_m = kMaxClearanceM;
  for (const PlanPose& at : plan.poses) plan.clearance_m = min.clearance_m(at.pose, plan.clearance_m);
  return plan;
}

// `driven`: cost of the incumbent.
Plan HybridPlanner::search(PricedGround& ground, const Clearances& margins, double driven, double horizon_m) const {
  const PlanRequest& request = ground.request;
  Plan plan;
  for (const LatticeExtent& extent : kExtents) {
    const PoseCostToGo pose_cost_to_go(config_.motion, config_.roll, margins, config_.footprint, request,
                                       ground.cost_to_go, horizon_m, extent, driven - config_.switching_cost_s);
    for (const double known_free_m : {config_.search.known_free_m, HybridAStarConfig::kMinKnownFreeM}) {
      ground.known_free_m = known_free_m;
      const double incumbent = incumbent_cost(ground);
      const int before = plan.expansions;
      plan = search_hybrid_a_star(config_.search, config_.motion, ground, pose_cost_to_go,
                                  incumbent - config_.switching_cost_s - pose_cost_to_go.common());
      plan.cost += pose_cost_to_go.common();
      plan.expansions += before;
      if (!plan.found && std::isfinite(incumbent)) return kept(incumbent, plan.expansions);
      if (plan.found || !plan.needs_unseen_ground) break;
    }
    plan.closed_in = !plan.found && !plan.needs_unseen_ground && !pose_cost_to_go.reaches(request.start);
    if (plan.found || plan.closed_in) break;
  }
  return plan;
}

// Infinite if it is blocked or ends in nothing.
double HybridPlanner::incumbent_cost(const PricedGround& ground) const {
  const std::vector<PlanPose>& poses = ground.request.incumbent;
  if (poses.size() < 2) return kInfinity;
  PathPricer pricer(config_.motion, ground);
  double cost = poses.back().motion_cost - poses.front().motion_cost;
  double distance_m = 0.0;
  for (size_t i = 1; i < poses.size() && std::isfinite(cost); ++i) {
    const Pose2& from = poses[i - 1].pose;
    const double step_m = distance(position(from), position(poses[i].pose));
    distance_m += poses[i].reverse ? -step_m : step_m;
    if (step_m > 0.0) {
      cost += step_m * pricer.cost_per_m(poses[i].pose, distance_m, poses[i].reverse);
      pricer.add_view(poses[i].pose);
    } else {
      const double turn_rad = poses[i].pose.yaw_rad - from.yaw_rad;
      const int steps = 1 + static_cast<int>(std::abs(turn_rad) / kTurnSampleRad);
      for (int k = 0; k <= steps; ++k) {
        const double factor = pricer.turn_factor({from.x_m, from.y_m, from.yaw_rad + turn_rad * k / steps}, distance_m);
        if (std::isinf(factor)) return kInfinity;
        cost += (factor - 1.0) * config_.motion.point_turn_s_per_rad * std::abs(turn_rad) / steps;
      }
      pricer.add_turn_views(from.yaw_rad, poses[i].pose);
    }
  }
  return cost + ground.cost_to_go.end_cost(position(poses.back().pose));
}

}  // namespace rover::planning
