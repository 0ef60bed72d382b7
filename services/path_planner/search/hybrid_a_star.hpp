// Hybrid A* (Dolgov et al., IJRR 2010) over place, heading and curvature: motions whose curvature changes no faster
// than the steering allows, forward and in reverse, point turns and cusps. The SE(2) cost-to-go is the heuristic.
#pragma once

#include "path_planner/search/footprint_check.hpp"
#include "path_planner/search/pose_cost_to_go.hpp"
#include "path_planner/search/roll.hpp"

namespace rover::planning {

struct HybridAStarConfig {
  static constexpr double kStepM = 0.3;  // length of a motion
  static constexpr double kHeuristicWeight = 1.1;
  double known_free_m = 2.5;                     // of a plan: this far, ground is known or comes into view in time
  static constexpr double kMinKnownFreeM = 0.6;  // the same, if that allows no plan
  int max_expansions = 3000;
};

// What paths are checked and priced on.
struct PricedGround {
  const PlanRequest& request;
  const CostToGo& cost_to_go;
  const FootprintCheck& comfort;
  const FootprintCheck& min;
  const FootprintCheck& turn;
  const RollCheck& roll;
  ViewArea view;
  double known_free_m = 0.0;
};

// Plans that cost more than `max_cost` are of no use. Costs are those of the lattice, relative to its common() [s].
Plan search_hybrid_a_star(const HybridAStarConfig& config, const MotionCosts& costs, const PricedGround& ground,
                          const PoseCostToGo& pose_cost_to_go, double max_cost);

constexpr double kTurnSampleRad = 0.0524;

// Prices poses one after the other along a path, by ground, clearance, and whether the ground comes into view before
// the rover is there.
class PathPricer {
 public:
  PathPricer(const MotionCosts& costs, const PricedGround& ground)
      : costs_(costs), ground_(ground), visibility_(*ground.request.costmap, ground.min, ground.view) {
    clear_views();
  }

  // But for those on the way to the start.
  void clear_views() {
    visibility_.clear();
    for (const Pose2& view : ground_.request.views) add_view(view);
  }
  void add_view(const Pose2& from) { visibility_.add_view(from); }
  // During a point turn to the pose, and at its end.
  void add_turn_views(double from_yaw_rad, const Pose2& to) {
    for (const Pose2& view : turn_views(from_yaw_rad, to)) add_view(view);
  }
  // A metre that ends at the pose, `distance_m` from the start, forward less reverse [s/m]; infinity: not allowed.
  double cost_per_m(const Pose2& pose, double distance_m, bool reverse);
  // In a point turn there: on the cost of turning; infinity: not allowed.
  double turn_factor(const Pose2& pose, double distance_m);
  bool needs_unseen_ground() const { return needs_unseen_ground_; }

 private:
  const MotionCosts& costs_;
  const PricedGround& ground_;
  Visibility visibility_;
  bool needs_unseen_ground_ = false;
};

}  // namespace rover::planning
