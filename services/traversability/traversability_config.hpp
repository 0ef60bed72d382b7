// Parameters of the traversability map. Lengths in metres, angles in radians.
#pragma once

#include <algorithm>

#include "common/core/vehicle.hpp"

namespace rover::trav {

struct PlaneConfig {
  double radius_m = 0.9;       // of the disc: half the length that wheels and body cover
  double min_share = 0.2;      // of the disc's cells seen; a corner of the seen ground leaves a quarter
  double min_spread_m = 0.15;  // standard deviation of their places along the narrow side
};

struct StepConfig {
  double reach_m = 0.25;      // wheel's diameter: a rise over this much way is a step
  double shown_share = 0.85;  // of a rock's height that the mean heights of cells show
  double foot_m = 0.08;       // what rises by this much beside an obstacle belongs to it
  double significance = 3.0;  // standard deviations; a smaller difference is no evidence
  double max_sigma_m = 0.06;  // cells beyond are as good as not seen
};

struct CostConfig {
  double max_slope_rad = 0.3316;  // 19 deg; impassable beyond
  double rough_m = 0.12;          // rms about the plane that costs as much as the steepest slope
  double slope_exponent = 1.7;    // 10/15/25/40 at 0/5/10/15 deg (Azkarate et al. 2020), scaled to the limit
  double step_exponent = 3.0;
  double rough_exponent = 2.0;
};

// The ground ahead that is judged as a whole, in body axes.
struct AheadConfig {
  double near_m = 1.0;
  double far_m = 6.0;
  double half_width_m = 2.0;
  double clearance_m = 0.6;      // ground nearer to an obstacle is blocked: half the rover's width and some room
  double min_known_share = 0.3;  // of its cells; below: no judgement
};

struct TraversabilityConfig {
  double hazard_height_m = 0.15;  // rocks and steps of this height and more are impassable
  double belly_clearance_m = 0.30;
  double footprint_m2 = 1.645;  // ground closed in by obstacles is part of them up to this area
  PlaneConfig plane;
  StepConfig step;
  CostConfig cost;
  AheadConfig ahead;

  // Heights as the map shows them.
  double step_limit_m() const { return step.shown_share * hazard_height_m; }
  double belly_limit_m() const { return step.shown_share * belly_clearance_m; }
};

// What the vehicle allows: the lowest of its limits counts.
inline void take_limits(const Vehicle& vehicle, TraversabilityConfig& config) {
  config.hazard_height_m = std::min(vehicle.hazard_height_m, vehicle.max_climb_m);
  config.belly_clearance_m = vehicle.belly_clearance_m;
  config.footprint_m2 = 4.0 * vehicle.footprint_half_length_m() * vehicle.footprint_half_width_m();
}

}  // namespace rover::trav
