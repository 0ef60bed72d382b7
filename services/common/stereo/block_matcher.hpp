// Block matching along rows (K. Konolige, "Small vision systems: hardware and implementation", 1997): the sum of
// absolute differences of clipped horizontal gradients over a square block, least over the search range, with texture
// and uniqueness tests, left-right check and speckle filter. What fails a test is invalid: a patch without texture has
// no disparity, never a guessed one.
//
// The loops over the search range are plain, for the compiler to vectorise, and compiled twice: for AVX2 and for the
// project's baseline. All numbers are integers, so both give the same bytes.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace rover::stereo {

struct MatcherConfig {
  int residual_min_px = -16;    // search range about the reference plane's disparity
  int residual_count_px = 64;   // multiple of 16
  int block_px = 11;            // odd; block_px^2 * 2 * prefilter_cap fits 16 bit
  int prefilter_cap = 31;       // gradients are clipped to +- this [grey levels]
  int texture_threshold = 200;  // sum of absolute clipped gradients over the block
  int uniqueness_percent = 12;  // margin of the best cost over the best one elsewhere
  int left_right_max_px = 1;
  int speckle_px = 120;       // smaller islands of disparity are removed
  int speckle_step_px16 = 2;  // within one island neighbours differ by no more [1/16 px]
};

// Pad of the matching images around the pixels that get a disparity, in pixels.
struct MatchPad {
  int left = 0;
  int right = 0;
  int rows = 0;  // above and below
};

class BlockMatcher {
 public:
  static constexpr std::int16_t kInvalid = INT16_MIN;

  explicit BlockMatcher(const MatcherConfig& config, bool avx2 = cpu_has_avx2());

  static bool cpu_has_avx2() { return __builtin_cpu_supports("avx2"); }
  // So wide that the blocks of all pixels and their search ranges are inside the image.
  static MatchPad pad(const MatcherConfig& config);

  // Padded images, 8 bit; a match with a right pixel that is not seen (0) is invalid. The result has no pad: CV_16S,
  // 1/16 px, the left pixel x with the value r matches the right pixel x - r / 16.
  const cv::Mat& match(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_seen);

 private:
  void match_avx2(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_seen);
  void match_baseline(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_seen);
  void match_rows(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_seen);
  void match_row(const std::uint8_t* right_seen, std::int16_t* residual);
  void prefilter(const cv::Mat& image, cv::Mat& gradient) const;

  MatcherConfig config_;
  MatchPad pad_;
  bool avx2_;
  cv::Mat left_gradient_;                      // CV_8S, below block_px rows of zeros
  cv::Mat right_gradient_;                     // the same
  std::vector<std::uint16_t> column_cost_;     // over the rows of the block, [column][index in the search range]
  std::vector<std::uint16_t> column_texture_;  // [column]
  std::vector<std::uint16_t> block_cost_;      // [index]
  std::vector<std::uint32_t> left_match_;      // of each pixel of a row
  std::vector<std::uint32_t> right_match_;
  cv::Mat residual_;  // CV_16S
  cv::Mat speckle_buffer_;
};

}  // namespace rover::stereo
