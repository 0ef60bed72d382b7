// From a cell and a step of yaw to the place between them where the heights differ least, and how sharp that place is.
#pragma once

#include <Eigen/Core>

#include "global_localization/terrain_match.hpp"

namespace rover::global {

struct RefinementConfig {
  double reach_cells = 3.0;  // to each side of the start
  double reach_rad = 0.05;
  int most_evaluations = 150;
};

struct Match {
  Placement placement;
  Fit fit;
};

// NLopt's BOBYQA: no derivatives, no clock, no chance. `least`: samples that must be compared.
Match refined(const OrbitalPart& orbital, const TerrainTemplate& terrain, const Placement& start, int least,
              const RefinementConfig& config);

// Covariance of the template's centre and yaw there: with n independent samples the logarithm of the likelihood is
// -n/2 log(residual^2). NaN where the residual grows not to all sides.
Eigen::Matrix3d covariance_of(const OrbitalPart& orbital, const TerrainTemplate& terrain, const Match& match,
                              double independent_samples);

}  // namespace rover::global
