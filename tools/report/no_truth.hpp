// A vehicle has no truth: its own estimate stands in for it, so that pictures and plots can be drawn, and the figures
// that only a truth can give are left out.
#pragma once

#include "tools/report/metrics.hpp"

namespace rover::report {

// The run with the estimated poses in the place of truth.
RunRecord with_estimate_for_truth(const RunRecord& run);
// Takes back what was measured against the stand-in.
void leave_out_truth_figures(Metrics& metrics);
// Whether the figures are by a truth.
inline bool has_truth(const Metrics& metrics) {
  return metrics.final_truth_pose.has_value();
}

}  // namespace rover::report
