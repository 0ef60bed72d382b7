// SE(2) cost-to-go: seconds to the goal from each place and heading near the rover, by A* backwards over a lattice of
// poses: arcs no tighter than the vehicle's, forward or in reverse, and point turns. Beyond the horizon the 2-D
// cost-to-go takes over. A 2-D field alone sends the rover into gaps that it cannot turn into.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "path_planner/search/cost_to_go.hpp"
#include "path_planner/search/motion_costs.hpp"
#include "path_planner/search/roll.hpp"

namespace rover::planning {

struct LatticeExtent {
  // Taken off each clearance. Positive: gaps stay open that a pose between those of the lattice fits through; negative:
  // only what surely fits.
  double slack_m = 0.0;
  double beyond_s = 0.0;  // the lattice is laid this far past the cost from the start
};

class PoseCostToGo {
 public:
  static constexpr int kHeadings = 32;

  // Plans from the start that cost more than `max_cost` are of no use [s].
  PoseCostToGo(const MotionCosts& costs, const RollCosts& roll_costs, const Clearances& clearances,
               const Footprint& footprint, const PlanRequest& request, const CostToGo& cost_to_go, double horizon_m,
               const LatticeExtent& extent, double max_cost);

  // Smallest of the lattice poses around this one; infinity: nothing leads to the goal, or beyond the horizon.
  double forward(const Pose2& pose) const { return nearby(pose, kForward); }
  double turning(const Pose2& pose) const { return nearby(pose, kTurn); }
  double reverse(const Pose2& pose) const { return nearby(pose, kReverse); }
  bool reaches(const Pose2& pose) const {
    return std::isfinite(std::min({forward(pose), turning(pose), reverse(pose)}));
  }
  // Whether a plan may end at the place although the goal is not there. One to back up may not.
  bool at_horizon(Point2 p) const {
    if (!request_.back_to.empty()) return false;
    const double dx = p.x_m - center_.x_m;
    const double dy = p.y_m - center_.y_m;
    return dx * dx + dy * dy >= horizon_m_ * horizon_m_;
  }
  // What follows a plan that ends at the pose [s]; infinity: it may not end there.
  double end_cost(const Pose2& pose) const { return end_at(position(pose)).cost(pose.yaw_rad); }
  // All costs are relative to this [s], that of the best place at the horizon: what plans have in common does not
  // count.
  double common() const { return common_; }

 private:
  enum Motion : std::uint8_t { kForward, kTurn, kReverse };
  static constexpr size_t kMotions = 3;
  // Clearance classes, each less than the one before. kTight is wide enough for a point turn.
  enum Clearance : std::uint8_t { kComfort, kTight, kNoTurn, kBlocked };
  static constexpr int kClearanceHeadings = kHeadings / 2;  // the footprint is the same from behind
  struct Arc {
    int from_heading;
    int to_heading;
    int dx;  // cells
    int dy;
    int to_end;  // difference of cell numbers
    int to_middle;
    int middle_heading;
    float length_m;
    float extra;  // cost beside the ground's [s]
  };

  // Of a plan at one place.
  struct End {
    double any_heading = kInfinity;  // [s]
    double best_yaw_rad = kNaN;      // other headings cost more; NaN: none does
    double cost(double yaw_rad) const;
  };

  void make_arcs();
  void classify();
  void rasterise(double margin_m, Clearance value);
  void mark(int heading, int row, int from, int to, Clearance value);
  void seed();
  void spread();
  void spread_forward(int cell, int heading, float cost);
  void spread_reverse(int cell, int heading, float cost);
  void spread_turn(int cell, int heading, float cost);
  End end_at(Point2 p) const;
  void offer(Motion motion, int cell, int heading, float cost);
  float arc_cost(int cell, const Arc& arc);
  float cost_per_m(int cell, int heading);
  float roll_factor(int cell, int heading);
  double nearby(const Pose2& pose, Motion motion) const;

  static double yaw_of(int heading) { return 2.0 * kPi * heading / kHeadings; }
  static int wrapped(int heading) { return (heading % kHeadings + kHeadings) % kHeadings; }
  static size_t state_of(Motion motion, int cell, int heading) {
    return (static_cast<size_t>(cell) * kMotions + motion) * kHeadings + static_cast<size_t>(heading);
  }
  Clearance clearance(int cell, int heading) const { return static_cast<Clearance>(classes_[class_of(cell, heading)]); }
  size_t class_of(int cell, int heading) const {
    return heading % kClearanceHeadings * ground_.size() + static_cast<size_t>(cell);
  }
  Point2 center_of(int cell) const {
    return {corner_.x_m + (cell % cells_ + 0.5) * cell_m_, corner_.y_m + (cell / cells_ + 0.5) * cell_m_};
  }
  bool inside(int cell, int dx, int dy) const;

  MotionCosts costs_;
  Clearances clearances_;
  Footprint footprint_;
  const PlanRequest& request_;
  const CostToGo& cost_to_go_;
  double horizon_m_;
  LatticeExtent extent_;
  double max_cost_;
  double from_start_to_goal_;  // lower bound [s]
  double common_ = 0.0;
  Point2 center_;
  double cell_m_;
  int cells_;
  Point2 corner_;
  std::vector<std::vector<Arc>> arcs_to_;    // by the heading at their end
  std::vector<std::vector<Arc>> arcs_from_;  // by the heading at their start
  std::vector<std::uint8_t> classes_;
  RollCheck roll_;
  std::vector<float> roll_factor_;  // as classes_; 0: not computed yet. Empty: all are 1
  std::vector<float> ground_;       // cost per metre of each cell [s/m]
  std::vector<float> from_start_;   // lower bound of the cost from the start
  std::vector<float> cost_;         // of each state
  std::vector<bool> closed_;
  std::vector<std::vector<std::uint32_t>> buckets_;
  size_t bucket_ = 0;
};

}  // namespace rover::planning
