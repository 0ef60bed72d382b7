// Continuous planning of the Full level: a plan from the rover to the goal line at the horizon, on what the NavCam's
// map and the hazard memory know together. The plan that is being driven is held as long as no other one is clearly
// cheaper.
#pragma once

#include <optional>

#include "path_planner/curve_search.hpp"

namespace rover::planning {

struct FullPlannerConfig {
  GoalFieldConfig goal;
  CurveSearchConfig search;
  double sure_way_m = 2.5;        // of a plan, over ground that is seen in time
  double least_sure_way_m = 0.6;  // where that leaves no way
  double hold_m = 3.0;            // of the plan that is being driven, kept where it is held
  double switch_gain_m = 1.0;     // by which another one has to be cheaper ...
  double switch_share = 0.1;      // ... and by that share of its cost
  double block_slack_m =
      0.03;  // by which a plan may come nearer than the least margin before it is blocked: hazards grow
  double sigma_margin_m = 0.02;    // for the pose: each half metre shows the ground anew. One that changed with the
                                   // pose's deviation would stop the rover, and let it go on once it stands
  double squeeze_margin_m = 0.04;  // the least, at a price (search.squeeze_factor)
  double least_corridor_m = 0.30;  // of a plan between hazards: on a slope a point turn slides by 0.2 m
  double doubt_from_m = 2.0;       // where that leaves no way: small spots of the map never nearer do not count ...
  int doubt_cells = 8;             // ... up to so many cells, unless the LocCam confirms them
  double latency_s = 0.1;          // of a plan, from the map to its release, message time
  double patience_s = 0.15;        // of the planner's step, for a plan without which the rover is stopped
  double turn_extra_m = 0.04;      // of the margin, for point turns: the rover does not halt exactly
  int most_retreats = 12;          // one after the other, without new ground gained
  int map_cells = 280;             // of the ground that is remembered, each way; their size is the hazard memory's
  double near_look_m = 3.0;        // a map from that near always tells the newest of a cell, one from afar may not
  double stale_way_m = 1.5;        // driven since the newest map, with which it is too old ...
  double stale_s = 5.0;            // ... if that took as long
};

// The way that is being driven, from where a new one could begin.
struct HeldWay {
  std::vector<Pose2> poses;  // every few cm, at least one
  double end_m = 0.0;        // along the path that is being driven
  double end_curvature_per_m = 0.0;
  double turn_left_rad = 0.0;  // of the point turns in it
  int halts = 0;               // likewise, those that have not begun
};

struct FullRequest {
  const Terrain* terrain = nullptr;
  Footprint footprint;
  ViewArea view;
  const Route& global;  // in odom
  double from_m = 0.0;  // along it: where the rover is ...
  double back_m = 0.0;  // ... and from how much further it has come back
  Pose2 rover;
  Pose2 start;  // of a new way
  double start_curvature_per_m = 0.0;
  Pose2 stopped;
  bool turning = false;  // the rover has begun a point turn: a new way gives that up
  bool may_back = true;  // stern first
  std::optional<HeldWay> held;
  double roomy_margin_m = 0.0;
  double tight_margin_m = 0.0;
  double squeeze_margin_m = 0.0;
  double turn_margin_m = 0.0;
  double goal_reach_m = 0.0;
  const std::vector<DeadEnd>& dead_ends;
};

struct FullPlan {
  CurvePlan plan;         // from the held way's end, or from the start
  bool held = false;      // goes on from the held way
  bool hopeless = false;  // by the lattice nothing leads on from the rover
  double clearance_m = kNaN;
  double cost = kInfinity;      // of the held way too
  double end_station_m = kNaN;  // along the global path
  double work_s = 0.0;          // about what it took, by what was done: the same on every machine
};

class FullPlanner {
 public:
  explicit FullPlanner(const FullPlannerConfig& config) : config_(config) {}
  // plan.found is false where there is no way.
  FullPlan plan(const FullRequest& request) const;

 private:
  GoalField goal_field(const FullRequest& request) const;
  FullPlan plan_on(const FullRequest& request, const GoalField& field, double slack_m,
                   const CurveSearchConfig& search) const;
  double held_cost(const CurveProblem& problem, const HeldWay& held) const;

  FullPlannerConfig config_;
};

}  // namespace rover::planning
