// Errors of block matching, applied to an exact disparity: smoothing over the block, correlated noise, holes around
// rocks and on ground without texture, and the limits of the search. Fitted to disparities
// of rendered images (test/rover_simulator/perception_study.cpp).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/disparity_plane.hpp"
#include "common/core/image.hpp"

namespace rover {

struct DisparityErrorConfig {
  float baseline_m = 0.12F;
  float search_min_px = -16.0F;
  float search_max_px = 47.0F;
  int smoothing_px = 3;           // half side of the block that is averaged on smooth ground
  float max_smoothing_px = 0.5F;  // a pixel that differs more from the average keeps its own disparity
  float sigma_px = 0.085F;        // of the noise where a pixel is smaller than sharp_m
  float sigma_per_m = 35.0F;      // growth with the size of a pixel
  float sharp_m = 0.0027F;        // size of a pixel: depth / focal length = baseline / disparity
  float max_sigma_px = 0.33F;
  int edge_hole_px = 3;       // width of the hole around a foreground
  float edge_jump_px = 2.0F;  // smallest jump of an edge, beyond that of steep ground over the hole
};

class DisparityErrors {
 public:
  static constexpr int kTexturePx = 8;  // side of the blocks whose texture is asked for

  DisparityErrors(const DisparityErrorConfig& config, int width, int height, std::uint64_t seed);

  // `exact_px`: of all pixels, 0 without ground. `textured(u, v)`: whether the ground at the pixel can be matched.
  // `reference`: the matcher searches about it.
  Disparity apply(const std::vector<float>& exact_px, const std::function<bool(int u, int v)>& textured,
                  const DisparityPlane& reference, std::int64_t frame) const;

 private:
  float sigma_px(float px) const;

  static constexpr int kNoiseMargin = 256;

  DisparityErrorConfig config_;
  int width_;
  int height_;
  std::uint64_t seed_;
  std::vector<float> noise_;  // of standard deviation 1; each frame takes another part of it
};

}  // namespace rover
