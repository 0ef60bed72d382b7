// Dense disparity of a rectified pair: block-matching residual plus the disparity of the reference plane.
#pragma once

#include "common/core/image.hpp"
#include "common/stereo/block_matcher.hpp"
#include "common/stereo/rectifier.hpp"

namespace rover::stereo {

class Matcher {
 public:
  explicit Matcher(const MatcherConfig& config);

  Disparity match(const RectifiedPair& pair, const Rectifier& rectifier);

 private:
  BlockMatcher block_matcher_;
};

}  // namespace rover::stereo
