// What motions cost beside the ground, for both searches.
#pragma once

namespace rover::planning {

struct MotionCosts {
  double seconds_per_m = 5.0;  // at cruise speed
  double max_curvature_per_m = 0.8;
  static constexpr double kCurvatureRatio = 0.8;  // of the largest curvature that the vehicle can drive
  static constexpr double kCurvature = 0.15;      // relative to driving, at the largest curvature
  double curvature_change_s = 2.0;                // for a change by the largest curvature, quadratic below
  double point_turn_s = 15.0;                     // steering to it and back
  double point_turn_s_per_rad = 5.0;
  static constexpr double kPointTurnSteeringS = 5.0;  // more, if the wheels come from the largest curvature
  double cusp_s = 7.5;                                // between forward and reverse
  double reverse_factor = 1.5;                        // on the cost in reverse
  double tight_factor = 2.5;                          // on the cost below the comfortable clearance, of point turns too
};

struct Clearances {
  double comfort_m = 0.15;  // footprint to the centre of a hazard cell; below, motions cost more
  double min_m = 0.09;      // never below
  double turn_m = 0.12;     // never below in a point turn: the rover does not stop exactly
  // A path is blocked below its smallest clearance less this, for hazards grow; what was driven had at least that.
  static constexpr double kToleranceM = 0.03;
};

}  // namespace rover::planning
