#include "rover_simulator/camera/disparity_errors.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

constexpr double kNoiseBlurPx = 3.0;  // the noise of neighbours shares most of their blocks: correlation 0.5 at 6 px

std::vector<float> noise_tile(int width, int height, std::uint64_t seed) {
  cv::Mat noise(height, width, CV_32F);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::uint64_t bits = hash64(seed, static_cast<std::uint64_t>(v) * width + u);
      noise.at<float>(v, u) = near_normal(static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32));
    }
  cv::GaussianBlur(noise, noise, {0, 0}, kNoiseBlurPx, kNoiseBlurPx, cv::BORDER_REFLECT);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(noise, mean, sigma);
  noise = (noise - mean[0]) / sigma[0];
  return {noise.begin<float>(), noise.end<float>()};
}

// For each row of blocks, whether the pixels of a column match.
std::vector<char> matched_columns_of_blocks(int width, int height, const std::function<bool(int u, int v)>& textured) {
  constexpr int kBlock = DisparityErrors::kTexturePx;
  std::vector<char> matched;
  for (int v = 0; v < height; v += kBlock)
    for (int u = 0; u < width; u += kBlock)
      matched.insert(matched.end(), static_cast<size_t>(std::min(kBlock, width - u)),
                     textured(std::min(u + kBlock / 2, width - 1), std::min(v + kBlock / 2, height - 1)));
  return matched;
}

}  // namespace

DisparityErrors::DisparityErrors(const DisparityErrorConfig& config, int width, int height, std::uint64_t seed)
    : config_(config),
      width_(width),
      height_(height),
      seed_(seed),
      noise_(noise_tile(width + kNoiseMargin, height + kNoiseMargin, seed)) {}

Disparity DisparityErrors::apply(const std::vector<float>& exact_px, const std::function<bool(int u, int v)>& textured,
                                 const DisparityPlane& reference, std::int64_t frame) const {
  const cv::Mat exact(height_, width_, CV_32F, const_cast<float*>(exact_px.data()));
  cv::Mat foreground;  // the highest disparity within the width_ of a hole
  const int hole = 2 * config_.edge_hole_px + 1;
  cv::dilate(exact, foreground, cv::Mat::ones(hole, hole, CV_8U));
  cv::Mat smooth;
  const int block = 2 * config_.smoothing_px + 1;
  cv::blur(exact, smooth, {block, block}, {-1, -1}, cv::BORDER_REFLECT);
  const std::vector<char> matched = matched_columns_of_blocks(width_, height_, textured);
  const std::uint64_t shift = hash64(seed_, static_cast<std::uint64_t>(frame));
  const auto first_row = static_cast<size_t>((shift >> 32) % kNoiseMargin);
  const auto first_column = static_cast<size_t>(shift % kNoiseMargin);

  Disparity out(width_, height_);
  for (int v = 0; v < height_; ++v) {
    const float* own = exact.ptr<float>(v);
    const float* highest = foreground.ptr<float>(v);
    const float* average = smooth.ptr<float>(v);
    const float* noise =
        &noise_[(first_row + static_cast<size_t>(v)) * static_cast<size_t>(width_ + kNoiseMargin) + first_column];
    const char* has_texture = &matched[static_cast<size_t>(v / kTexturePx) * width_];
    for (int u = 0; u < width_; ++u) {
      if (own[u] <= 0.0F || !has_texture[u] || highest[u] - own[u] > config_.edge_jump_px) continue;
      const float seen = std::abs(average[u] - own[u]) < config_.max_smoothing_px ? average[u] : own[u];
      const float px = seen + sigma_px(seen) * noise[u];
      const auto residual = px - static_cast<float>(reference.at(u, v));
      const bool searched = residual >= config_.search_min_px && residual <= config_.search_max_px;
      if (px > 0.0F && px <= static_cast<float>(u) && searched)
        out.at(u, v) = static_cast<std::int16_t>(16.0F * px + 0.5F);
    }
  }
  return out;
}

float DisparityErrors::sigma_px(float px) const {
  const float growth_px = config_.sigma_per_m * std::max(config_.baseline_m / px - config_.sharp_m, 0.0F);
  return std::min(config_.sigma_px + growth_px, config_.max_sigma_px);
}

}  // namespace rover
