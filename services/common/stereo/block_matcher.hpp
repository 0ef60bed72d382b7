// Block matching along rows (K. Konolige, "Small vision systems: hardware and implementation", 1997): the sum of
// absolute differences (SAD) of clipped horizontal gradients over a square block is minimised over the search range,
// with texture and uniqueness tests, left-right check and speckle filter. A pixel that fails a test is invalid.
//
// The loops are compiled twice, for AVX2 and for the project's baseline; integer arithmetic makes both byte-identical.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace rover::stereo {

struct MatcherConfig {
  int residual_min_px = -16;    // search range relative to the reference plane's disparity
  int residual_count_px = 64;   // multiple of 16
  int block_px = 11;            // odd; block_px^2 * 2 * prefilter_cap fits 16 bit
  int prefilter_cap = 31;       // gradients are clipped to +- this [grey levels]
  int texture_threshold = 200;  // minimum sum of absolute clipped gradients over the block
  int uniqueness_percent = 12;  // margin by which other minima must cost more
  int left_right_max_px = 1;
  int speckle_px = 120;       // connected regions smaller than this are removed
  int speckle_step_px16 = 2;  // maximum step between connected neighbours [1/16 px]
};

// Padding of the matching images around the pixels with disparity, in pixels.
struct MatchPad {
  int left = 0;
  int right = 0;
  int rows = 0;  // above and below
};

class BlockMatcher {
 public:
  static constexpr std::int16_t kInvalid = INT16_MIN;

  explicit BlockMatcher(const MatcherConfig& config, bool avx2 = cpu_has_avx2());

  static bool cpu_has_avx2();  // false if not x86-64
  // Padding that keeps the blocks and search ranges of all pixels inside the image.
  static MatchPad pad(const MatcherConfig& config);

  // Padded 8-bit images; a match with a right pixel masked by 0 is invalid. The result is unpadded CV_16S in 1/16 px:
  // left pixel x with value r matches right pixel x - r / 16.
  const cv::Mat& match(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_valid);

 private:
  void match_avx2(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_valid);
  void match_baseline(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_valid);
  void match_rows(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_valid);
  void match_row(const std::uint8_t* right_valid, std::int16_t* residual);
  void prefilter(const cv::Mat& image, cv::Mat& gradient) const;

  MatcherConfig config_;
  MatchPad pad_;
  bool avx2_;
  cv::Mat left_gradient_;  // CV_8S, preceded by block_px rows of zeros
  cv::Mat right_gradient_;
  std::vector<std::uint16_t> column_cost_;     // summed over the block's rows, [column][index in the search range]
  std::vector<std::uint16_t> column_texture_;  // [column]
  std::vector<std::uint16_t> block_cost_;      // [index]
  std::vector<std::uint32_t> left_match_;      // per pixel of the current row
  std::vector<std::uint32_t> right_match_;
  cv::Mat residual_;  // CV_16S
  cv::Mat speckle_buffer_;
};

}  // namespace rover::stereo
