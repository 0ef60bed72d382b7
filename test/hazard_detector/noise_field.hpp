// Stereo-like noise for many frames of one scene: an independent part and a part correlated within matching blocks.
// Samples are drawn once and read at a different offset for each frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/core/image.hpp"

namespace rover::synthetic {

class NoiseField {
 public:
  explicit NoiseField(std::uint64_t seed) : random_(seed), normal_(1 << 20) {
    std::normal_distribution<float> normal;
    for (float& value : normal_) value = normal(random_);
  }

  // `drop`: fraction of blocks without stereo.
  Disparity apply(const std::vector<float>& exact, const StereoCamera& camera, double sigma_px, double drop) {
    const size_t white = random_() % normal_.size(), shared = random_() % normal_.size(),
                 lost = random_() % normal_.size();
    const float drop_below = static_cast<float>(drop > 0.0 ? quantile(drop) : -1e9);
    const float sigma16 = static_cast<float>(16.0 * sigma_px);
    Disparity disparity(camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const size_t i = static_cast<size_t>(v) * camera.width + u;
        const size_t block = static_cast<size_t>(v / 6) * 131 + static_cast<size_t>(u / 6);
        if (exact[i] <= 0.0f || at(lost + block) < drop_below) continue;
        const float noise = 0.6f * at(white + i) + 0.8f * at(shared + block);
        disparity.px16[i] = static_cast<std::int16_t>(std::max(1.0f, std::round(16.0f * exact[i] + sigma16 * noise)));
      }
    return disparity;
  }

 private:
  float at(size_t i) const { return normal_[i & (normal_.size() - 1)]; }
  // Quantile of the normal distribution, by bisection.
  static double quantile(double probability) {
    double low = -5.0, high = 5.0;
    for (int i = 0; i < 40; ++i) {
      const double mid = 0.5 * (low + high);
      (0.5 * std::erfc(-mid / std::sqrt(2.0)) < probability ? low : high) = mid;
    }
    return low;
  }

  std::mt19937_64 random_;
  std::vector<float> normal_;
};

}  // namespace rover::synthetic
