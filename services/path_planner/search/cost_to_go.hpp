// 2-D cost-to-go: seconds from each cell of the costmap to the goal, or where backing up may end, heading aside. Fast
// marching from there, or, if the goal lies outside, from the border, with the rest estimated along the global path.
#pragma once

#include <vector>

#include "common/core/fast_marching.hpp"
#include "path_planner/search/plan.hpp"

namespace rover::planning {

struct CostToGoConfig {
  double seconds_per_m = 5.0;                         // at cruise speed
  static constexpr double kClearanceDistanceM = 0.6;  // a cell costs more within this distance beyond the margin
  double clearance_cost = 0.5;                        // relative to driving, at the margin
  double off_path_factor = 1.05;  // beyond the costmap the rover returns to the global path; it costs this much more
  double goal_miss_cost = 3.0;    // relative to driving, per metre that a plan ends off the goal
  double blocked_goal_radius_m = 1.2;  // a plan may end this far from a goal with hazards
};

class CostToGo {
 public:
  CostToGo(const CostToGoConfig& config, const PlanRequest& request, const Footprint& footprint, double margin_m);

  // Of a metre with the body origin in the cell of the costmap [s/m]; infinity: not passable.
  double cost_per_m(int cell) const;
  double cost_per_m(Point2 p) const { return costmap_.contains(p) ? cost_per_m(costmap_.cell_of(p)) : kInfinity; }
  // [s]; infinity: nothing leads to the goal.
  double at(Point2 p) const { return costmap_.contains(p) ? to_goal_[coarse_cell(costmap_.cell_of(p))] : kInfinity; }
  // Direction in which the cost-to-go falls.
  double descent_rad(Point2 p) const;
  // Of ending at a place near the goal [s]; infinity: it is none.
  double goal_cost(Point2 p) const;
  // What follows a path that ends at the place [s].
  double end_cost(Point2 p) const {
    const double goal = goal_cost(p);
    return std::isfinite(goal) ? goal : at(p);
  }

 private:
  static constexpr int kCoarse = 2;  // cells of the costmap per cell of the march, in x and y

  int coarse_cell(int cell) const {
    return cell / costmap_.cells() / kCoarse * coarse_cells_ + cell % costmap_.cells() / kCoarse;
  }
  // To the nearest hazard that does not pass under the body, beside the rover's half width and margin.
  double room_m(int cell) const { return tall_distance_m_[cell] - half_width_m_ - margin_m_; }
  void march_from_goal(const PlanRequest& request);
  double beyond(const std::vector<Point2>& ahead, double left_m, Point2 p) const;

  CostToGoConfig config_;
  const Costmap& costmap_;
  std::vector<float> ground_cost_;  // of each cell, relative to driving
  double half_width_m_;
  double margin_m_;
  Point2 rover_;
  std::vector<BackUpPlace> goals_;  // on the costmap
  double goal_tolerance_m_;
  double goal_reach_m_;  // a plan may end this far from a goal
  int coarse_cells_;
  std::vector<double> tall_distance_m_;  // to the nearest hazard that does not pass under the body
  double room_at_rover_m_;
  std::vector<double> to_goal_;
};

}  // namespace rover::planning
