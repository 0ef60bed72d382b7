// Dense disparity of a rectified pair: block matching on horizontal gradients (OpenCV's StereoBM, after K. Konolige,
// "Small vision systems", 1997) with texture and uniqueness tests, left-right check and speckle filter. What fails a
// test is invalid: a patch without texture has no disparity, never a guessed one.
#pragma once

#include <opencv2/calib3d.hpp>

#include "common/core/image.hpp"
#include "stereo/rectifier.hpp"

namespace rover::stereo {

struct MatcherConfig {
  int residual_min_px = -16;    // search range about the reference plane's disparity
  int residual_count_px = 64;   // multiple of 16
  int block_px = 11;            // odd
  int prefilter_cap = 31;       // gradients are clipped to +- this [grey levels]
  int texture_threshold = 200;  // sum of absolute clipped gradients over the block
  int uniqueness_percent = 12;  // margin of the best cost over the best one elsewhere
  int left_right_max_px = 1;
  int speckle_px = 120;     // smaller islands of disparity are removed
  int speckle_step_px = 2;  // within one island neighbours differ by no more
};

class Matcher {
 public:
  explicit Matcher(const MatcherConfig& config);

  static MatchPad pad(const MatcherConfig& config);
  Disparity match(const RectifiedPair& pair, const Rectifier& rectifier);

 private:
  MatcherConfig config_;
  cv::Ptr<cv::StereoBM> block_matching_;
  cv::Mat residual_;  // CV_16S, 1/16 px
};

}  // namespace rover::stereo
