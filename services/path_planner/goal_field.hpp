// Where a continuous plan may end, and what is left to go from anywhere: the goal line across the global path at the
// horizon, or the goal itself, or (dearly) the rim of the map; and the travel field (fast marching) to it over the
// ground's cost.
#pragma once

#include <vector>

#include "common/core/fast_marching.hpp"
#include "path_planner/route.hpp"
#include "path_planner/terrain.hpp"

namespace rover::planning {

struct GoalFieldConfig {
  double horizon_m = 8.0;         // of the goal line, along the global path
  double max_deviation_m = 20.0;  // from the global path
  double return_way_m = 8.0;      // past the goal line, on which a plan's offset from the global path is taken out
  double heading_cost_m = 0.8;    // per radian between a plan's end and the global path
  double goal_miss_cost = 3.0;    // per metre that a plan ends off the goal
  double unknown_cost = 1.0;      // per metre more
  double difficulty_cost = 1.5;   // per metre more, on ground that is barely passable
  double doubt_from = 0.7;  // difficulty beyond which a rock may prove a hazard from near; slopes that are driven ...
  double doubt_cost = 4.0;  // ... stay below. Per metre more, on ground that is barely passable
  double risk_distance_m = 0.6;  // clearance below which ground costs more
  double risk_cost = 0.5;        // per metre more, at the margin
  double dead_end_reach_m = 0.8;
};

struct GoalQuery {
  const Terrain& terrain;
  const Route& global;  // in odom
  double from_m = 0.0;  // along it: where the rover is
  Point2 rover;
  double half_width_m = 0.0;  // of the vehicle
  double margin_m = 0.0;      // the least
  double goal_reach_m = 0.0;
  const std::vector<DeadEnd>& dead_ends;
  double back_m = 0.0;  // by which the rover has come back along the global path: the goal line stays where it was
};

class GoalField {
 public:
  GoalField(const GoalFieldConfig& config, const GoalQuery& query);

  // False where nothing of the goal line is free.
  bool reachable() const { return reachable_; }
  // Of the ground under a pose's centre, per metre; infinity: not passable, or outside.
  double cost_per_m(Point2 p) const { return terrain_.contains(p) ? cost_.cost_per_m[terrain_.cell_of(p)] : kInfinity; }
  // What is left from a place, heading aside; infinity where nothing leads on.
  double to_go(Point2 p) const { return terrain_.contains(p) ? travel_[terrain_.cell_of(p)] : kInfinity; }
  // Of the way from the rover to a cell, heading aside; infinity where none leads there.
  double from_rover(int cell) const { return from_rover_[cell]; }
  // What a plan that ends at the pose costs more; infinity: it may not end there.
  double end_cost(const Pose2& pose) const;
  // How far a place lies past the goal line; negative before it. In sight of the goal: zero.
  double past_line_m(Point2 p) const { return goal_in_sight_ ? 0.0 : station_m(p) - line_m_; }
  // Along the global path.
  double station_m(Point2 p) const { return terrain_.contains(p) ? station_[terrain_.cell_of(p)] : kInfinity; }

 private:
  void lay_stations();
  void lay_costs();
  void march_from_goal();
  void march_from_rover();
  double difficulty_cost(double difficulty) const;
  double off_path_m(Point2 p, double station_m) const;
  double line_cost(Point2 p) const;
  bool at_rim(Point2 p) const;
  double rim_cost(Point2 p) const;

  GoalFieldConfig config_;
  const GoalQuery query_;
  const Terrain& terrain_;
  double line_m_;  // along the global path
  bool goal_in_sight_ = false;
  bool line_in_sight_ = false;  // across the global path, before its end
  Point2 goal_;
  bool reachable_ = false;
  std::vector<double> station_;
  std::vector<double> offset_;
  MarchGrid cost_;
  std::vector<double> travel_;
  std::vector<double> from_rover_;
};

}  // namespace rover::planning
