// Parameters of the traversability map. Lengths in metres, angles in radians.
#pragma once

#include <algorithm>

#include "common/core/frames.hpp"
#include "common/core/vehicle.hpp"

namespace rover::trav {

struct PlaneConfig {
  double radius_m = 0.9;           // of the disc: half the length of the rover
  double min_seen_fraction = 0.2;  // of the disc's cells that must be seen; a corner of the seen area has a quarter
  double min_spread_m = 0.15;      // standard deviation of the cells' positions along the minor axis
};

struct StepConfig {
  double radius_m = 0.25;           // wheel diameter: a rise within this distance is a step
  double mean_height_ratio = 0.85;  // of a rock's height that remains in the mean heights of cells
  double rim_fraction = 1.0 / 3.0;  // of the limit: a cell beside a rock that rises so much is its rim, covered in part
  double grow_height_m = 0.08;      // lower rise threshold for neighbours of an obstacle
  double significance = 3.0;        // standard deviations; smaller differences are noise
  double max_sigma_m = 0.06;        // cells above are unknown
};

struct CostConfig {
  double max_slope_rad = to_rad(19.0);  // impassable beyond
  double max_roughness_m = 0.12;        // rms about the plane with the maximum cost
  double slope_exponent = 1.7;          // fits 10/15/25/40 at 0/5/10/15 deg (Azkarate et al. 2020), scaled to the limit
  double step_exponent = 3.0;
  double roughness_exponent = 2.0;
};

// Region ahead for the difficulty, in body axes.
struct AheadConfig {
  double near_m = 1.0;
  double far_m = 6.0;
  double half_width_m = 2.0;
  double clearance_m = 0.6;         // cells nearer to an obstacle are blocked: half the rover's width plus margin
  double min_known_fraction = 0.3;  // of its cells; below: NaN
};

struct TraversabilityConfig {
  double hazard_height_m = 0.15;  // rocks and steps from this height are impassable
  double body_height_m = 0.20;    // lower ones pass under the body, between the wheels
  double belly_clearance_m = 0.30;
  double footprint_m2 = 1.645;  // enclosed regions up to this area are obstacles
  PlaneConfig plane;
  StepConfig step;
  CostConfig cost;
  AheadConfig ahead;

  // Limits for mean heights of cells.
  double step_limit_m() const { return step.mean_height_ratio * hazard_height_m; }
  double body_limit_m() const { return step.mean_height_ratio * body_height_m; }
  double belly_limit_m() const { return step.mean_height_ratio * belly_clearance_m; }
};

// The lower of hazard height and climb limit applies.
inline void apply_vehicle_limits(const Vehicle& vehicle, TraversabilityConfig& config) {
  config.hazard_height_m = std::min(vehicle.hazard_height_m, vehicle.max_climb_m);
  config.body_height_m = vehicle.max_climb_m;
  config.belly_clearance_m = vehicle.belly_clearance_m;
  config.footprint_m2 = 4.0 * vehicle.footprint_half_length_m() * vehicle.footprint_half_width_m();
}

}  // namespace rover::trav
