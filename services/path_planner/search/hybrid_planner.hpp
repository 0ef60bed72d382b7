// The planner for both levels: 2-D cost-to-go, SE(2) cost-to-go, hybrid A*. The incumbent is priced on the same ground,
// and another plan replaces it only if it is cheaper by the switching cost.
#pragma once

#include "path_planner/search/hybrid_a_star.hpp"

namespace rover::planning {

struct HybridPlannerConfig {
  Footprint footprint;
  ViewArea view;
  Clearances clearances;
  MotionCosts motion;
  RollCosts roll;
  CostToGoConfig cost_to_go;
  HybridAStarConfig search;
  double horizon_m = 8.0;  // of headings and clearances; beyond, the 2-D cost-to-go
  double switching_cost_s = 4.0;
};

class HybridPlanner final : public Planner {
 public:
  explicit HybridPlanner(const HybridPlannerConfig& config) : config_(config) {}
  Plan plan(const PlanRequest& request) const override;

 private:
  Plan search(PricedGround& ground, const Clearances& margins, double driven, double horizon_m) const;
  double incumbent_cost(const PricedGround& ground) const;

  HybridPlannerConfig config_;
};

}  // namespace rover::planning
