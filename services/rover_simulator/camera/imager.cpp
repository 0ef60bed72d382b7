// Noise model: EMVA 1288, shot noise sqrt(electrons) and signal-independent read noise.
#include "rover_simulator/camera/imager.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "common/core/check.hpp"
#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

// Separable three-tap kernel in one pass, with replicated border.
void blur_row(const RadianceImage& image, int v, float weight, std::vector<float>& vertical, std::vector<float>& out) {
  const int w = image.width;
  const float centre = 1.0F - 2.0F * weight;
  const float* above = &image.data[static_cast<size_t>(std::max(v - 1, 0)) * w];
  const float* here = &image.data[static_cast<size_t>(v) * w];
  const float* below = &image.data[static_cast<size_t>(std::min(v + 1, image.height - 1)) * w];
  for (int u = 0; u < w; ++u) vertical[u + 1] = centre * here[u] + weight * (above[u] + below[u]);
  vertical[0] = vertical[1];
  vertical[w + 1] = vertical[w];
  for (int u = 0; u < w; ++u) out[u] = centre * vertical[u + 1] + weight * (vertical[u] + vertical[u + 2]);
}

}  // namespace

Imager::Imager(const ImagerConfig& config, int width, int height)
    : config_(config), vignetting_(static_cast<size_t>(width) * height) {
  const double cx = 0.5 * (width - 1);
  const double cy = 0.5 * (height - 1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double r2 = ((u - cx) * (u - cx) + (v - cy) * (v - cy)) / (cx * cx + cy * cy);
      vignetting_[static_cast<size_t>(v) * width + u] = static_cast<float>(1.0 - config.vignetting * r2);
    }
  }
}

void Imager::expose_row(const RadianceImage& radiance, double exposure_s, std::uint64_t noise_key, int v,
                        GrayImage& image) const {
  const int w = radiance.width;
  std::vector<float> vertical(static_cast<size_t>(w) + 2);
  std::vector<float> light(static_cast<size_t>(w));
  blur_row(radiance, v, static_cast<float>(config_.blur_weight), vertical, light);

  const auto grey_per_light = static_cast<float>(255.0 * exposure_s * config_.radiance_per_second);
  const auto electrons_per_grey = static_cast<float>(config_.full_well_e / 255.0);
  const auto read_variance = static_cast<float>(config_.read_noise_e * config_.read_noise_e);
  const auto key_a = static_cast<std::uint32_t>(noise_key);
  const auto key_b = static_cast<std::uint32_t>(noise_key >> 32);
  const float* vignetting = &vignetting_[static_cast<size_t>(v) * w];
  std::uint8_t* out = &image.data[static_cast<size_t>(v) * w];
  for (int u = 0; u < w; ++u) {
    const auto pixel = static_cast<std::uint32_t>(v * w + u);
    const float grey = light[u] * vignetting[u] * grey_per_light;
    const float sigma = std::sqrt(grey * electrons_per_grey + read_variance) / electrons_per_grey;
    const float noisy = grey + sigma * near_normal(hash32(pixel ^ key_a), hash32(pixel + key_b));
    out[u] = static_cast<std::uint8_t>(std::min(std::max(noisy + 0.5F, 0.0F), 255.0F));
  }
}

double next_exposure_s(const ImagerConfig& config, double exposure_s, double mean) {
  const double ratio = config.exposure_target / std::max(mean, 1.0);
  return std::clamp(exposure_s * std::pow(ratio, config.exposure_gain), config.exposure_min_s, config.exposure_max_s);
}

double metered_exposure_s(const ImagerConfig& config, const RadianceImage& radiance) {
  ROVER_CHECK(!radiance.data.empty());
  const double mean =
      std::accumulate(radiance.data.begin(), radiance.data.end(), 0.0) / static_cast<double>(radiance.data.size());
  const double exposure_s = config.exposure_target / (255.0 * config.radiance_per_second * std::max(mean, 1e-6));
  return std::clamp(exposure_s, config.exposure_min_s, config.exposure_max_s);
}

double mean_grey(const GrayImage& image) {
  return static_cast<double>(std::accumulate(image.data.begin(), image.data.end(), std::uint64_t{0})) /
         static_cast<double>(image.data.size());
}

}  // namespace rover
