// Removes foreground fattening at the upper edges of near objects: a block that straddles an edge takes the near
// disparity for half a block beyond it. Behind a rock's top this is a ridge in the air, up to a metre long.
#pragma once

#include "common/core/image.hpp"

namespace rover::cloud {

struct FatteningConfig {
  double min_jump_px = 1.5;      // of disparity, above that of steep ground
  double slope_px_per_px = 0.4;  // per row; ground rising by 15 deg has 0.35
  int width_px = 5;              // half a block; 0: off
};

// Invalidates the near disparities within `width_px` rows below a jump.
void remove_foreground_fattening(Disparity& disparity, const FatteningConfig& config);

}  // namespace rover::cloud
