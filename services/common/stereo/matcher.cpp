#include "common/stereo/matcher.hpp"

#include <cmath>

namespace rover::stereo {

Matcher::Matcher(const MatcherConfig& config) : block_matcher_(config) {}

Disparity Matcher::match(const RectifiedPair& pair, const Rectifier& rectifier) {
  const cv::Mat& residual = block_matcher_.match(pair.match_left, pair.match_right, rectifier.match_right_valid());
  const DisparityPlane& plane = rectifier.reference();
  Disparity disparity(residual.cols, residual.rows);
  for (int v = 0; v < disparity.height; ++v) {
    const std::int16_t* row = residual.ptr<std::int16_t>(v);
    const double row_px16 = 16.0 * plane.at(0.0, v) + 0.5;
    for (int u = 0; u < disparity.width; ++u) {
      const int r = row[u];
      if (r == BlockMatcher::kInvalid) continue;
      const int px16 = r + static_cast<int>(std::floor(row_px16 + plane.per_u * (16.0 * u - r)));
      if (px16 > 0 && px16 <= INT16_MAX) disparity.at(u, v) = static_cast<std::int16_t>(px16);
    }
  }
  return disparity;
}

}  // namespace rover::stereo
