// Sub-cell refinement of a match by minimising the height residual, and the covariance from its curvature.
#pragma once

#include <Eigen/Core>

#include "global_localization/terrain_match.hpp"

namespace rover::global {

struct RefinementConfig {
  double half_width_cells = 3.0;  // bounds around the start
  double half_width_rad = to_rad(3.0);
  int max_evaluations = 150;
};

struct Match {
  CandidatePose pose;
  Fit fit;
};

// NLopt's BOBYQA: derivative-free, deterministic, no time limit. `min_compared`: minimum number of compared samples.
Match refine(const OrbitalSection& orbital, const TerrainTemplate& terrain, const CandidatePose& start,
             int min_compared, const RefinementConfig& config);

// Covariance of the template's centre and yaw from the Hessian of the log-likelihood -n/2 log(residual^2) with n
// independent samples. `max_sigma_m`: of directions without curvature; of yaw, at the template's radius. NaN beside the
// map's border.
Eigen::Matrix3d covariance_at_minimum(const OrbitalSection& orbital, const TerrainTemplate& terrain, const Match& match,
                                      double independent_samples, double max_sigma_m);

}  // namespace rover::global
