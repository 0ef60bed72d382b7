// Consistency of visual odometry: normalised estimation error squared (NEES) of its alignments with a keyframe against
// the truth, by the covariance that it states (Bar-Shalom, Li and Kirubarajan 2001, ch. 5.4).
#pragma once

#include "tools/report/track.hpp"

namespace rover::report {

// Averages over the keyframes, divided by the degrees of freedom: 1 is consistent, more is overconfident. Errors of
// calibration and of the truth count as well.
struct VisualConsistency {
  int keyframes = 0;
  double translation = kNaN;
  double rotation = kNaN;
  double together = kNaN;  // 6 degrees of freedom
};

// The last alignment of each keyframe, the sum of all motions since it: those of one keyframe share their errors.
VisualConsistency visual_consistency(const RunRecord& run, const TrueTrack& truth);

}  // namespace rover::report
