#include "stereo/matcher.hpp"

#include <algorithm>
#include <cmath>

namespace rover::stereo {
namespace {

// StereoBM computes 1/256 px and rounds to 1/16 px with (x + 15) >> 4, which is (15 - 7.5) / 256 px too much on
// average.
constexpr double kRoundingBiasPx16 = 7.5 / 16.0;

}  // namespace

Matcher::Matcher(const MatcherConfig& config)
    : config_(config), block_matching_(cv::StereoBM::create(config.residual_count_px, config.block_px)) {
  block_matching_->setMinDisparity(config.residual_min_px);
  block_matching_->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  block_matching_->setPreFilterCap(config.prefilter_cap);
  block_matching_->setTextureThreshold(config.texture_threshold);
  block_matching_->setUniquenessRatio(config.uniqueness_percent);
  block_matching_->setDisp12MaxDiff(config.left_right_max_px);
  block_matching_->setSpeckleWindowSize(config.speckle_px);
  block_matching_->setSpeckleRange(config.speckle_step_px);
}

// StereoBM leaves out the columns whose whole search range or block is not inside the image.
MatchPad Matcher::pad(const MatcherConfig& config) {
  const int block = config.block_px / 2;
  const int residual_max_px = config.residual_min_px + config.residual_count_px - 1;
  return {std::max(residual_max_px, 0) + block, std::max(-config.residual_min_px, 0) + block, block};
}

Disparity Matcher::match(const RectifiedPair& pair, const Rectifier& rectifier) {
  block_matching_->compute(pair.match_left, pair.match_right, residual_);
  const StereoCamera& camera = rectifier.camera();
  const MatchPad& pad = rectifier.pad();
  const DisparityPlane& plane = rectifier.reference();
  const int invalid = (config_.residual_min_px - 1) * 16;
  const cv::Mat& seen = rectifier.match_right_seen();
  Disparity disparity(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    const std::int16_t* residual = residual_.ptr<std::int16_t>(v + pad.rows) + pad.left;
    const std::uint8_t* seen_row = seen.ptr<std::uint8_t>(v + pad.rows) + pad.left;
    const double row_px16 = 16.0 * plane.at(0.0, v) + 0.5 - kRoundingBiasPx16;
    for (int u = 0; u < camera.width; ++u) {
      const int r = residual[u];
      if (r <= invalid || seen_row[u - (r >> 4)] == 0) continue;
      const int px16 = r + static_cast<int>(std::floor(row_px16 + plane.per_u * (16.0 * u - r)));
      if (px16 > 0 && px16 <= INT16_MAX) disparity.at(u, v) = static_cast<std::int16_t>(px16);
    }
  }
  return disparity;
}

}  // namespace rover::stereo
