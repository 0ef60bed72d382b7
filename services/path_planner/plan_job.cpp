#include "path_planner/plan_job.hpp"

namespace rover::planning {

PlanJob::PlanJob(const FullPlannerConfig& config, const HazardMemory& memory, const GroundMap& ground,
                 const Route& global, const std::vector<DeadEnd>& dead_ends)
    : config_(config),
      memory_(memory),
      ground_(ground),
      global_(global),
      dead_ends_(dead_ends),
      request_{.global = global_, .held = {}, .dead_ends = dead_ends_} {}

FullPlan PlanJob::run() const {
  const FullPlanner planner(config_);
  const Terrain known(memory_, &ground_, Terrain::Reach::kGround);
  FullRequest request = request_;
  request.terrain = &known;
  FullPlan plan = planner.plan(request);
  const auto go_on_with = [&plan](FullPlan next) {
    next.work_s += plan.work_s;
    plan = std::move(next);
  };
  if (!plan.plan.found) {
    request.turn_margin_m = request.squeeze_margin_m;
    go_on_with(planner.plan(request));
  }
  if (!plan.plan.found) go_on_with(run_in_doubt({position(request.rover), config_.doubt_from_m, config_.doubt_cells}));
  if (!plan.plan.found) go_on_with(run_in_doubt({position(request.rover), 0.0, config_.doubt_cells, true}));
  return plan;
}

FullPlan PlanJob::run_in_doubt(const Terrain::Doubt& doubt) const {
  const Terrain doubted(memory_, &ground_, Terrain::Reach::kGround, doubt);
  FullRequest request = request_;
  request.terrain = &doubted;
  request.may_back = doubt.if_seen_free;  // astern nothing looks there
  return FullPlanner(config_).plan(request);
}

}  // namespace rover::planning
