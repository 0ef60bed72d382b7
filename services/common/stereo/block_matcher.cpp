#include "common/stereo/block_matcher.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/calib3d.hpp>

#include "common/core/check.hpp"

namespace rover::stereo {
namespace {

// Index k of the search range is the residual max - k, so candidate right pixels are contiguous in memory.
// A match is encoded as cost << 16 | index, so the smaller number is the better match.
constexpr std::uint32_t kNoMatch = UINT32_MAX;
constexpr int cost_of(std::uint32_t match) {
  return static_cast<int>(match >> 16);
}
constexpr int index_of(std::uint32_t match) {
  return static_cast<int>(match & 0xFFFF);
}

int residual_max_px(const MatcherConfig& config) {
  return config.residual_min_px + config.residual_count_px - 1;
}

// Clipped horizontal Sobel gradient of one row, without its first and last pixel.
void x_sobel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width, int cap,
             std::int8_t* __restrict gradient) {
  for (int x = 1; x < width - 1; ++x) {
    const int sum = (above[x + 1] - above[x - 1]) + 2 * (row[x + 1] - row[x - 1]) + (below[x + 1] - below[x - 1]);
    gradient[x] = static_cast<std::int8_t>(std::clamp(sum, -cap, cap));
  }
}

// Gradient rows that enter and leave the block, starting at the first block's first column (right image: at the first
// pixel of that column's search range).
struct BlockRows {
  const std::int8_t* left_in;
  const std::int8_t* left_out;
  const std::int8_t* right_in;
  const std::int8_t* right_out;
};

// Updates the column costs, [column][index].
void slide_down(const BlockRows& rows, int columns, int count, std::uint16_t* __restrict cost) {
  for (int x = 0; x < columns; ++x) {
    const int in = rows.left_in[x], out = rows.left_out[x];
    for (int k = 0; k < count; ++k)
      cost[k] = static_cast<std::uint16_t>(cost[k] + std::abs(in - rows.right_in[x + k]) -
                                           std::abs(out - rows.right_out[x + k]));
    cost += count;
  }
}

void slide_down(const BlockRows& rows, int columns, std::uint16_t* __restrict texture) {
  for (int x = 0; x < columns; ++x)
    texture[x] = static_cast<std::uint16_t>(texture[x] + std::abs(rows.left_in[x]) - std::abs(rows.left_out[x]));
}

void slide_right(const std::uint16_t* column_in, const std::uint16_t* column_out, int count,
                 std::uint16_t* __restrict cost) {
  for (int k = 0; k < count; ++k) cost[k] = static_cast<std::uint16_t>(cost[k] + column_in[k] - column_out[k]);
}

std::uint32_t min_cost_match(const std::uint16_t* cost, int count) {
  std::uint32_t best = kNoMatch;
  for (int k = 0; k < count; ++k) best = std::min(best, static_cast<std::uint32_t>(cost[k]) << 16 | k);
  return best;
}

// The best match, if all indices except its neighbours exceed its cost by the margin.
std::uint32_t unique_match(const std::uint16_t* cost, int count, int margin_percent) {
  const std::uint32_t best = min_cost_match(cost, count);
  const int k = index_of(best);
  const auto limit = static_cast<std::uint16_t>(std::min(cost_of(best) * (100 + margin_percent) / 100, UINT16_MAX));
  std::uint16_t within = 0;
  for (int i = 0; i < count; ++i) within = static_cast<std::uint16_t>(within + (cost[i] <= limit));
  for (int i = std::max(k - 1, 0); i <= std::min(k + 1, count - 1); ++i)
    within = static_cast<std::uint16_t>(within - (cost[i] <= limit));
  return within == 0 ? best : kNoMatch;
}

// Sub-pixel offset [1/16 px] by equiangular (V-shaped) interpolation, suited to SAD costs; 0 at the ends of the range.
int subpixel_px16(const std::uint16_t* cost, int count, int best) {
  if (best == 0 || best == count - 1) return 0;
  const int cost_nearer = cost[best - 1], cost_farther = cost[best + 1];
  const int rise = std::max(cost_nearer, cost_farther) - cost[best];
  if (rise == 0) return 0;
  return (16 * (cost_farther - cost_nearer) + 17 * rise) / (2 * rise) - 8;  // 8 (farther - nearer) / rise, rounded
}

// Invalidates left pixels whose residual disagrees with the best match of their right pixel, or whose right pixel is
// masked.
void check_left_right(const std::uint32_t* left_match, const std::uint32_t* right_match,
                      const std::uint8_t* right_valid, int width, int max_px, std::int16_t* residual) {
  for (int x = 0; x < width; ++x) {
    if (left_match[x] == kNoMatch) continue;
    const int k = index_of(left_match[x]);
    const bool agrees = std::abs(index_of(right_match[x + k]) - k) <= max_px;
    if (!agrees || right_valid[x + k] == 0) residual[x] = BlockMatcher::kInvalid;
  }
}

}  // namespace

#ifdef __x86_64__
#define ROVER_AVX2 gnu::target("avx2"),
bool BlockMatcher::cpu_has_avx2() {
  return __builtin_cpu_supports("avx2");
}
#else
#define ROVER_AVX2
bool BlockMatcher::cpu_has_avx2() {
  return false;
}
#endif

BlockMatcher::BlockMatcher(const MatcherConfig& config, bool avx2) : config_(config), pad_(pad(config)), avx2_(avx2) {
  ROVER_CHECK(config.block_px * config.block_px * 2 * config.prefilter_cap <= UINT16_MAX, config.block_px,
              config.prefilter_cap);
}

MatchPad BlockMatcher::pad(const MatcherConfig& config) {
  const int block = config.block_px / 2;
  return {std::max(residual_max_px(config), 0) + block, std::max(-config.residual_min_px, 0) + block, block};
}

const cv::Mat& BlockMatcher::match(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_valid) {
  if (avx2_)
    match_avx2(left, right, right_valid);
  else
    match_baseline(left, right, right_valid);
  cv::filterSpeckles(residual_, kInvalid, config_.speckle_px, config_.speckle_step_px16, speckle_buffer_);
  return residual_;
}

// `flatten` compiles all callees for AVX2. target_clones is not used: its ifunc runs before AddressSanitizer is ready.
[[ROVER_AVX2 gnu::flatten]] void BlockMatcher::match_avx2(const cv::Mat& left, const cv::Mat& right,
                                                          const cv::Mat& right_valid) {
  match_rows(left, right, right_valid);
}

[[gnu::flatten]] void BlockMatcher::match_baseline(const cv::Mat& left, const cv::Mat& right,
                                                   const cv::Mat& right_valid) {
  match_rows(left, right, right_valid);
}

// Separable running box sum. block_px rows and columns of zeros precede the data, so the first blocks need no special
// case.
void BlockMatcher::match_rows(const cv::Mat& left, const cv::Mat& right, const cv::Mat& right_valid) {
  const int block = config_.block_px, count = config_.residual_count_px;
  const int columns = left.cols - pad_.left - pad_.right + block - 1;
  prefilter(left, left_gradient_);
  prefilter(right, right_gradient_);
  residual_.create(left.rows - block + 1, columns - block + 1, CV_16S);
  column_cost_.assign(static_cast<size_t>(block + columns) * count, 0);
  column_texture_.assign(static_cast<size_t>(block + columns), 0);
  for (int y = 0; y < left.rows; ++y) {
    const int left_from = pad_.left - pad_.rows, right_from = left_from - residual_max_px(config_);
    const BlockRows rows{
        left_gradient_.ptr<std::int8_t>(y + block) + left_from, left_gradient_.ptr<std::int8_t>(y) + left_from,
        right_gradient_.ptr<std::int8_t>(y + block) + right_from, right_gradient_.ptr<std::int8_t>(y) + right_from};
    slide_down(rows, columns, count, column_cost_.data() + block * count);
    slide_down(rows, columns, column_texture_.data() + block);
    if (y < block - 1) continue;
    const std::uint8_t* valid_row = right_valid.ptr(y - pad_.rows) + right_from + pad_.rows;
    match_row(valid_row, residual_.ptr<std::int16_t>(y - block + 1));
  }
}

void BlockMatcher::match_row(const std::uint8_t* right_valid, std::int16_t* residual) {
  const int block = config_.block_px, count = config_.residual_count_px, width = residual_.cols;
  left_match_.resize(static_cast<size_t>(width));
  right_match_.assign(static_cast<size_t>(width + count), kNoMatch);
  block_cost_.assign(static_cast<size_t>(count), 0);
  std::uint16_t* cost = block_cost_.data();
  int texture = 0;
  for (int x = 1 - block; x < width; ++x) {
    const int out = x + block - 1, in = out + block;
    slide_right(&column_cost_[in * count], &column_cost_[out * count], count, cost);
    texture += column_texture_[in] - column_texture_[out];
    if (x < 0) continue;
    const bool textured = texture >= config_.texture_threshold;
    const std::uint32_t match = textured ? unique_match(cost, count, config_.uniqueness_percent) : kNoMatch;
    left_match_[x] = match;
    residual[x] = kInvalid;
    if (match == kNoMatch) continue;
    const int k = index_of(match);
    right_match_[x + k] = std::min(right_match_[x + k], match);
    residual[x] = static_cast<std::int16_t>(16 * (residual_max_px(config_) - k) + subpixel_px16(cost, count, k));
  }
  check_left_right(left_match_.data(), right_match_.data(), right_valid, width, config_.left_right_max_px, residual);
}

void BlockMatcher::prefilter(const cv::Mat& image, cv::Mat& gradient) const {
  const int block = config_.block_px, last = image.rows - 1;
  gradient.create(image.rows + block, image.cols, CV_8S);
  gradient = cv::Scalar(0);
  for (int y = 0; y <= last; ++y)
    x_sobel(image.ptr(y > 0 ? y - 1 : 1), image.ptr(y), image.ptr(y < last ? y + 1 : last - 1), image.cols,
            config_.prefilter_cap, gradient.ptr<std::int8_t>(y + block));
}

}  // namespace rover::stereo
