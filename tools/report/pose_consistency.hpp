// Consistency of POSE: normalised estimation error squared (NEES) against the truth, by the published covariance of
// T_map_body (Bar-Shalom, Li and Kirubarajan 2001, ch. 5.4). The covariance includes the uncertainty of the start pose,
// so the error is the plain difference in map.
#pragma once

#include "tools/report/track.hpp"

namespace rover::report {

// Averages over the samples, divided by the degrees of freedom: 1 is consistent, more is overconfident.
struct PoseConsistency {
  int samples = 0;
  double x = kNaN;
  double y = kNaN;
  double yaw = kNaN;
  double xyyaw = kNaN;  // the three together, 3 degrees of freedom
};

// Samples once a second. Poses without a positive definite covariance are left out.
PoseConsistency pose_consistency(const RunRecord& run, const TrueTrack& truth, const Window& window);

// First POSE with an accepted correction; infinity: none.
double first_fix_s(const RunRecord& run);

}  // namespace rover::report
