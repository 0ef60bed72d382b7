// What a block matcher tells wrongly above near things. A block that straddles a rim takes the near surface's residual
// for half a block beyond it; above a rock's top, where residuals are about the slope of the ground, that is a ridge in
// the air behind the rock, as tall as the rock and up to a metre long. (At its sides it makes a rock 3 cm wider 5 m
// away.)
#pragma once

#include "common/core/image.hpp"

namespace rover::cloud {

struct RimConfig {
  double jump_px = 1.5;          // of disparity to the far side, beyond what steep ground shows
  double steep_px_per_px = 0.4;  // ground rising by 15 deg shows 0.35 to the row above
  int width_px = 5;              // half a block; 0: rims are left as they are
};

// Takes the near side's disparities within `width_px` rows below a jump.
void take_rims(Disparity& disparity, const RimConfig& config);

}  // namespace rover::cloud
