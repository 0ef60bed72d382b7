#include "common/stereo/matcher_config.hpp"

namespace rover::stereo {

void add_matcher(Parameters p, MatcherConfig& c) {
  p.add("residual_min_px", c.residual_min_px, {-256, 256}, "start of the search, relative to the ground's disparity");
  p.add("residual_count_px", c.residual_count_px, {16, 512}, "width of the search range; a multiple of 16");
  p.add("block_px", c.block_px, {5, 51}, "side of a block, odd: 11 is 2.4 cm at 2 m; smaller: more noise");
  p.add("prefilter_cap", c.prefilter_cap, {1, 63}, "gradients are clipped to +- this, in grey levels");
  p.add("texture_threshold", c.texture_threshold, {1, 1e5}, "minimum sum of clipped gradients over the block");
  p.add("uniqueness_percent", c.uniqueness_percent, {1, 100},
        "margin by which other minima must cost more: at 5 noise alone is matched, from 8 on none");
  p.add("left_right_max_px", c.left_right_max_px, {0, 16}, "largest difference in the left-right check");
  p.add("speckle_px", c.speckle_px, {0, 1e5}, "smaller connected regions are removed");
  p.add("speckle_step_px16", c.speckle_step_px16, {1, 16},
        "largest step within a region; at 4 and more twice as many outliers stay");
  p.check(c.residual_count_px % 16 == 0, "residual_count_px", "must be a multiple of 16");
  p.check(c.block_px % 2 != 0, "block_px", "must be odd");
  p.check(c.block_px * c.block_px * 2 * c.prefilter_cap <= UINT16_MAX, "block_px",
          "is too large for this prefilter_cap: a block's cost must fit 16 bit");
}

}  // namespace rover::stereo
