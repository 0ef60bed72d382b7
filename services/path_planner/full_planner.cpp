#include "path_planner/full_planner.hpp"

namespace rover::planning {
namespace {

constexpr double kSeenAboutM = 0.04;  // the rover follows a path within centimetres
constexpr double kSlackM = 0.03;
constexpr double kAmpleM = 2.0;

// What takes how long on one core of the machine of test/results/full.md, over 840 plans.
constexpr double kFieldsS = 0.05;  // the fast-marching fields and the lattice's rooms
constexpr double kSettledS = 1.1e-7;
constexpr double kExpansionS = 1.8e-5;

}  // namespace

// The held way's ground is priced as that of a new one; point turns in it cost what is left of them.
double FullPlanner::held_cost(const CurveProblem& problem, const HeldWay& held) const {
  double cost = config_.search.turn_cost_m * held.halts + config_.search.turn_cost_per_rad_m * held.turn_left_rad;
  for (size_t i = 1; i < held.poses.size(); ++i) {
    const double step = distance(position(held.poses[i - 1]), position(held.poses[i]));
    cost += step * pose_cost_per_m(problem, config_.search, held.poses[i]);
  }
  return cost;
}

GoalField FullPlanner::goal_field(const FullRequest& request) const {
  return {config_.goal,
          {*request.terrain, request.global, request.from_m, position(request.rover), request.footprint.half_width_m,
           request.squeeze_margin_m, request.goal_reach_m, request.dead_ends, request.back_m}};
}

// The lattice lets through what almost fits; where that leads the search astray, one that does not is asked, and last
// the first one in haste.
FullPlan FullPlanner::plan(const FullRequest& request) const {
  const GoalField field = goal_field(request);
  FullPlan out;
  if (!field.reachable()) return out;
  const CurveSearchConfig& search = config_.search;
  out = plan_on(request, field, kSlackM, search);
  if (out.plan.found || out.hopeless) return out;
  FullPlan sure = plan_on(request, field, -kSlackM, search);
  sure.work_s += out.work_s;
  if (sure.plan.found || out.plan.expansions < search.max_expansions) return sure;
  CurveSearchConfig hasty = search;
  hasty.greed = search.hasty_greed;
  FullPlan last = plan_on(request, field, kSlackM, hasty);
  last.work_s += sure.work_s;
  return last;
}

FullPlan FullPlanner::plan_on(const FullRequest& request, const GoalField& field, double slack_m,
                              const CurveSearchConfig& search) const {
  FullPlan out;
  const HeadingField headings(
      search, {*request.terrain, field, request.footprint, request.rover, request.roomy_margin_m, request.turn_margin_m,
               request.tight_margin_m, request.squeeze_margin_m, slack_m, request.may_back});
  out.work_s = kFieldsS + kSettledS * headings.settled();
  // With less room there is no more of a way.
  out.hopeless = !request.held && std::isinf(headings.to_go(request.start)) &&
                 std::isinf(headings.to_go_turning(request.stopped)) &&
                 std::isinf(headings.to_go_backing(request.stopped));
  if (out.hopeless) return out;
  const auto check = [&](double margin_m) {
    return FootprintCheck(*request.terrain, request.footprint, margin_m, kSeenAboutM, request.rover);
  };
  const FootprintCheck roomy = check(request.roomy_margin_m);
  const FootprintCheck tight = check(request.tight_margin_m);
  const FootprintCheck squeeze = check(request.squeeze_margin_m);
  const FootprintCheck turn = check(request.turn_margin_m);
  CurveProblem problem{field,
                       headings,
                       roomy,
                       tight,
                       squeeze,
                       turn,
                       request.view,
                       request.start,
                       request.start_curvature_per_m,
                       0.0,
                       request.stopped,
                       kInfinity,
                       request.may_back};
  double most = kInfinity;
  double held_cost_m = 0.0;
  if (request.held) {
    held_cost_m = held_cost(problem, *request.held);
    CurveProblem rest = problem;
    rest.start = rest.stopped = request.held->poses.back();
    rest.start_curvature_per_m = request.held->end_curvature_per_m;
    if (std::isfinite(held_cost_m)) out.plan = search_curves(search, rest);
    out.held = out.plan.found;
    if (out.held) most = (held_cost_m + out.plan.cost - config_.switch_gain_m) / (1.0 + config_.switch_share);
  }
  if (request.turning) most -= config_.search.turn_cost_m;
  for (const double sure_m : {config_.sure_way_m, config_.least_sure_way_m}) {
    problem.sure_m = sure_m;
    problem.most_cost = most;
    CurvePlan fresh = search_curves(search, problem);
    out.plan.expansions += fresh.expansions;
    const bool unseen = fresh.unseen_in_the_way;
    if (fresh.found) {
      fresh.expansions = out.plan.expansions;
      out.plan = std::move(fresh);
      out.held = false;
    }
    if (out.plan.found) break;
    out.plan.unseen_in_the_way = unseen;
    if (!unseen) break;
  }
  out.work_s += kExpansionS * out.plan.expansions;
  if (!out.plan.found) return out;
  out.cost = out.plan.cost + (out.held ? held_cost_m : 0.0);
  out.clearance_m = kAmpleM;
  for (const Pose2& pose : out.plan.poses) out.clearance_m = squeeze.clearance_m(pose, out.clearance_m);
  if (out.held)
    for (const Pose2& pose : request.held->poses) out.clearance_m = squeeze.clearance_m(pose, out.clearance_m);
  out.end_station_m = field.station_m(position(out.plan.poses.back()));
  return out;
}

}  // namespace rover::planning
