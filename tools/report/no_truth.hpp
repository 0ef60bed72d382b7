// Logs without TRUTH: the estimated pose replaces it for pictures and plots; metrics that need ground truth are
// removed.
#pragma once

#include "tools/report/metrics.hpp"

namespace rover::report {

// The run with estimated poses in place of TRUTH.
RunRecord with_estimate_for_truth(const RunRecord& run);
// Removes the metrics that compare the estimate with itself.
void leave_out_truth_figures(Metrics& metrics);
// True if the metrics are based on ground truth.
inline bool has_truth(const Metrics& metrics) {
  return metrics.final_truth_pose.has_value();
}

}  // namespace rover::report
