// Views of a sweep, ordered to start ahead and to keep moves short.
#pragma once

#include "common/core/frames.hpp"
#include "pan_tilt/gaze.hpp"

namespace rover::gaze {

struct SweepConfig {
  double pan_max_rad = to_rad(60.0);  // to either side
  double pan_step_rad = to_rad(30.0);
  double far_tilt_rad = 0.0;
  double near_tilt_rad = to_rad(24.0);
};

// Pan 0, then in steps to the right, then to the left; both tilts at each pan, in alternating order.
std::vector<Gaze> sweep_views(const SweepConfig& config);

}  // namespace rover::gaze
