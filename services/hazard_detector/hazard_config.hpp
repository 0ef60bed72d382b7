// Parameters of the hazard detector.
#pragma once

#include <optional>

#include "common/core/frames.hpp"
#include "hazard_detector/ground_calibration.hpp"

namespace rover::hazard {

struct GridConfig {
  double cell_m = 0.1;
  double min_x_m = 0.5;  // body frame
  double max_x_m = 4.0;
  double half_width_m = 2.0;
};

// Prior of the ground plane ahead: it is under the rover, so slope and offset are bounded.
struct PlanePrior {
  double front_axle_x_m = 0.75;         // front axle
  double max_slope_rad = to_rad(12.0);  // relative to the plane under the rover
  double max_offset_m = 0.14;           // at the front axle; 10 deg of body pitch cause 0.13
  double inlier_m = 0.05;               // inlier distance in the search
  double tukey_m = 0.12;                // Tukey scale: larger residuals have no weight
  double half_weight_m = 1.0;           // distance ahead of the front axle at which a cell weighs half
  int min_cells = 40;                   // fewer measured cells: the prior is used
};

// Local ground height relative to the plane; the deviation bound grows with the distance from the front axle.
struct LocalGroundConfig {
  double window_m = 0.6;                // half side of the neighbourhood
  double node_m = 0.3;                  // node spacing of the local ground grid
  double low_quantile = 0.25;           // of the neighbourhood heights: ground under rocks
  double high_quantile = 0.75;          // ground around holes
  double max_deviation_m = 0.05;        // at the front axle
  double max_deviation_m_per_m = 0.05;  // growth per metre ahead
  int min_cells = 12;
  double step_radius_m = 0.2;      // obstacle height also counts from the lowest cell within this radius
  double step_tolerance_m = 0.02;  // added to that cell: slope of the ground over that radius
};

struct HazardConfig {
  double origin_height_m = 0.62;                 // body origin over flat ground
  std::optional<GroundCalibration> calibration;  // nullopt: use the camera mount
  GridConfig grid;
  PlanePrior plane;
  LocalGroundConfig local_ground;
  double obstacle_height_m = 0.15;  // T_near: obstacles are higher than this over the local ground
  double body_height_m = 0.20;      // lower obstacles pass under the body, between the wheels
  double hole_depth_m = 0.20;       // T_far: holes are deeper than this
  double grow_height_m = 0.08;      // region growing: neighbours of an obstacle higher than this belong to it
  int min_cell_samples = 3;         // hazard samples that make a cell suspect
  int min_cluster_samples = 12;     // hazard samples of a connected component
  double min_free_fraction = 0.5;   // fraction of expected samples measured as ground
  int min_free_samples = 4;
  double margin_m = 0.10;
  double roi_near_m = 0.4;  // region of interest: ground ahead of the camera
  double roi_far_m = 3.0;
  double min_coverage = 0.4;  // fraction of its samples with valid stereo; below: BLIND
  int samples_per_cell = 5;   // along each side of a cell, if the image resolution allows
  int max_step_px = 4;
};

}  // namespace rover::hazard
