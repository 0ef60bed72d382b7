#include "common/stereo/matcher_config.hpp"

namespace rover::stereo {

void read_matcher(const Config& yaml, MatcherConfig& matcher) {
  yaml.read("residual_min_px", matcher.residual_min_px, {-256, 256});
  yaml.read("residual_count_px", matcher.residual_count_px, {16, 512});
  yaml.read("block_px", matcher.block_px, {5, 51});
  yaml.read("prefilter_cap", matcher.prefilter_cap, {1, 63});
  yaml.read("texture_threshold", matcher.texture_threshold, {1, 1e5});
  yaml.read("uniqueness_percent", matcher.uniqueness_percent, {1, 100});
  yaml.read("left_right_max_px", matcher.left_right_max_px, {0, 16});
  yaml.read("speckle_px", matcher.speckle_px, {0, 1e5});
  yaml.read("speckle_step_px16", matcher.speckle_step_px16, {1, 16});
  if (matcher.residual_count_px % 16 != 0) yaml.fail("residual_count_px", "must be a multiple of 16");
  if (matcher.block_px % 2 == 0) yaml.fail("block_px", "must be odd");
  if (matcher.block_px * matcher.block_px * 2 * matcher.prefilter_cap > UINT16_MAX)
    yaml.fail("block_px", "is too large for this prefilter_cap: a block's cost must fit 16 bit");
}

}  // namespace rover::stereo
