// Parameters of the hazard detector. Lengths in metres, angles in radians.
#pragma once

#include <optional>

#include "hazard_detector/ground_calibration.hpp"

namespace rover::hazard {

struct GridConfig {
  double cell_m = 0.1;
  double min_x_m = 0.5;  // body axes
  double max_x_m = 4.0;
  double half_width_m = 2.0;
};

// What is known of the ground ahead before it is seen: the rover stands on it.
struct PlanePrior {
  double wheel_line_x_m = 0.75;   // front axle
  double max_slope_rad = 0.2094;  // 12 deg against the plane the rover stands on
  double max_offset_m = 0.14;     // at the wheel line; 10 deg about the body origin make 0.13
  double inlier_m = 0.05;         // half band of a plane's supporters in the search
  double tukey_m = 0.12;          // residuals beyond do not pull the refined plane
  double near_weight_m = 1.0;     // a cell this far ahead of the wheel line weighs half
  int min_cells = 40;             // with fewer measured cells the prior stands
};

// The ground may bend away from the plane, within bounds that grow with the distance from the wheels.
struct ReliefConfig {
  double window_m = 0.6;        // half side of the neighbourhood that makes a local ground
  double node_m = 0.3;          // between nodes of the local ground
  double low_quantile = 0.25;   // of the neighbourhood's heights: ground under rocks
  double high_quantile = 0.75;  // ground around holes
  double bound_m = 0.05;        // at the wheel line
  double bound_per_m = 0.05;    // more for each metre ahead
  int min_cells = 12;
  double step_reach_m = 0.2;   // obstacles also count from the lowest cell within this distance
  double step_slack_m = 0.02;  // plus this: slope of the ground against the plane over that distance
};

struct HazardConfig {
  double ground_below_m = 0.62;                  // of the body origin on flat ground
  std::optional<GroundCalibration> calibration;  // none: from the camera's mount
  GridConfig grid;
  PlanePrior prior;
  ReliefConfig relief;
  double near_m = 0.15;          // T_near: an obstacle stands higher than this over its ground
  double far_m = 0.20;           // T_far: a hole is deeper than this
  double grow_m = 0.08;          // cells beside an obstacle that stand higher than this belong to it
  int min_cell_samples = 3;      // hazard samples that make a cell suspect
  int min_cluster_samples = 12;  // hazard samples of connected suspect cells that make a hazard
  double free_share = 0.5;       // of a cell's samples must be measured ground for FREE
  int min_free_samples = 4;
  double margin_m = 0.10;
  double roi_near_m = 0.4;  // region of interest: ground ahead of the camera
  double roi_far_m = 3.0;
  double min_coverage = 0.4;  // of its samples, below: BLIND
  int samples_per_cell = 5;   // along each side of a cell, where the image resolves them
  int max_step_px = 4;
};

}  // namespace rover::hazard
