// The views of a sweep, in an order that shows what is ahead first and turns little.
#pragma once

#include "common/core/frames.hpp"
#include "pan_tilt/gaze.hpp"

namespace rover::gaze {

struct SweepConfig {
  double pan_max_rad = to_rad(60.0);  // to either side
  double pan_step_rad = to_rad(30.0);
  std::vector<double> tilts_rad = {0.0, to_rad(24.0)};
};

// Ahead, then step by step to the right, back over the middle, and to the left; each with every tilt, in turns from the
// first and from the last.
std::vector<Gaze> sweep_views(const SweepConfig& config);

}  // namespace rover::gaze
