#include "rover_simulator/camera/disparity_errors.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

constexpr double kNoiseBlurPx = 3.0;  // the noise of neighbours shares most of their blocks: correlation 0.5 at 6 px

std::vector<float> noise_tile(int side, std::uint64_t seed) {
  cv::Mat noise(side, side, CV_32F);
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      const std::uint64_t bits = hash64(seed, static_cast<std::uint64_t>(v) * side + u);
      noise.at<float>(v, u) = near_normal(static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32));
    }
  cv::GaussianBlur(noise, noise, {0, 0}, kNoiseBlurPx, kNoiseBlurPx, cv::BORDER_REFLECT);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(noise, mean, sigma);
  noise = (noise - mean[0]) / sigma[0];
  return {noise.begin<float>(), noise.end<float>()};
}

}  // namespace

DisparityErrors::DisparityErrors(const DisparityErrorConfig& config, std::uint64_t seed)
    : config_(config), seed_(seed), noise_(noise_tile(kNoiseSide, seed)) {}

Disparity DisparityErrors::apply(const std::vector<float>& exact_px, int width, int height,
                                 const std::function<bool(int u, int v)>& textured, const DisparityPlane& reference,
                                 std::int64_t frame) const {
  const cv::Mat exact(height, width, CV_32F, const_cast<float*>(exact_px.data()));
  cv::Mat foreground;  // the highest disparity within the width of a hole
  const int hole = 2 * config_.edge_hole_px + 1;
  cv::dilate(exact, foreground, cv::Mat::ones(hole, hole, CV_8U));
  cv::Mat smooth;
  const int block = 2 * config_.smoothing_px + 1;
  cv::blur(exact, smooth, {block, block}, {-1, -1}, cv::BORDER_REFLECT);
  std::vector<char> has_texture;
  for (int v = 0; v < height; v += kTexturePx)
    for (int u = 0; u < width; u += kTexturePx)
      has_texture.push_back(
          textured(std::min(u + kTexturePx / 2, width - 1), std::min(v + kTexturePx / 2, height - 1)));
  const int blocks_per_row = (width + kTexturePx - 1) / kTexturePx;
  const std::uint64_t shift = hash64(seed_, static_cast<std::uint64_t>(frame));
  const auto sigma_px = [this](float px) {
    const double pixel_m = config_.baseline_m / px;
    const double growth_px = config_.sigma_per_m * std::max(pixel_m - config_.sharp_m, 0.0);
    return static_cast<float>(std::min(config_.sigma_px + growth_px, config_.max_sigma_px));
  };
  const auto max_smoothing_px = static_cast<float>(config_.max_smoothing_px);
  const auto jump_px = static_cast<float>(config_.edge_jump_px);

  Disparity out(width, height);
  for (int v = 0; v < height; ++v) {
    const float* noise = &noise_[((shift >> 10) + static_cast<std::uint64_t>(v)) % kNoiseSide * kNoiseSide];
    for (int u = 0; u < width; ++u) {
      const float own = exact.at<float>(v, u);
      if (own <= 0.0F || !has_texture[static_cast<size_t>(v / kTexturePx) * blocks_per_row + u / kTexturePx]) continue;
      if (foreground.at<float>(v, u) - own > jump_px) continue;
      const float average = smooth.at<float>(v, u);
      const float seen = std::abs(average - own) < max_smoothing_px ? average : own;
      const float px = seen + sigma_px(seen) * noise[(shift + static_cast<std::uint64_t>(u)) % kNoiseSide];
      const double residual = px - reference.at(u, v);
      const bool in_view = static_cast<float>(u) - px >= 0.0F;
      if (px <= 0.0F || !in_view || residual < config_.search_min_px || residual > config_.search_max_px) continue;
      out.at(u, v) = static_cast<std::int16_t>(std::lround(16.0F * px));
    }
  }
  return out;
}

}  // namespace rover
