// Roll of the body at a pose, from the heights under its wheels (as ACE: Otsu et al., J. Field Robotics 37, 2020). FDIR
// slows the rover from some roll on, and stops it from more.
#pragma once

#include "path_planner/map/costmap.hpp"

namespace rover::planning {

struct RollCosts {
  double max_rad = to_rad(18.0);              // of a plan
  double cost = 3.0;                          // relative to driving, at the largest roll
  static constexpr double kFreeRatio = 0.75;  // of the largest; less costs nothing
  // For a path as the map changes, and for the lattice, between whose poses those of a plan lie.
  static constexpr double kToleranceRad = to_rad(1.5);
};

class RollCheck {
 public:
  // More is allowed up to the roll that the rover has, and where it backs up. `tolerance_rad` is added.
  RollCheck(const RollCosts& costs, const Costmap& costmap, const Footprint& footprint, const Pose2& rover,
            double tolerance_rad = 0.0);

  bool allows(const Pose2& pose) const { return roll_rad(pose) <= limit_rad_; }
  // On the cost of a metre; infinity: not allowed.
  double factor(const Pose2& pose) const;
  // Without sign; 0 where the height under a wheel is not known.
  double roll_rad(const Pose2& pose) const;

 private:
  RollCosts costs_;
  const Costmap& costmap_;
  Footprint footprint_;
  double limit_rad_;
};

}  // namespace rover::planning
