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
  double baseline_m = 0.12;
  double search_min_px = -16.0;
  double search_max_px = 47.0;
  int smoothing_px = 3;           // half side of the block that is averaged on smooth ground
  double max_smoothing_px = 0.5;  // a pixel that differs more from the average keeps its own disparity
  double sigma_px = 0.085;        // of the noise where a pixel is smaller than sharp_m
  double sigma_per_m = 35.0;      // growth with the size of a pixel
  double sharp_m = 0.0024;        // size of a pixel: depth / focal length = baseline / disparity
  double max_sigma_px = 0.33;
  int edge_hole_px = 4;       // width of the hole around a foreground
  double edge_jump_px = 2.0;  // smallest jump of an edge, beyond that of steep ground over the hole
};

class DisparityErrors {
 public:
  static constexpr int kTexturePx = 8;  // side of the blocks whose texture is asked for

  DisparityErrors(const DisparityErrorConfig& config, std::uint64_t seed);

  // `exact_px`: 0 without ground. `textured(u, v)`: whether the ground at the pixel can be matched. `reference`: the
  // matcher searches about it.
  Disparity apply(const std::vector<float>& exact_px, int width, int height,
                  const std::function<bool(int u, int v)>& textured, const DisparityPlane& reference,
                  std::int64_t frame) const;

 private:
  static constexpr int kNoiseSide = 1024;

  DisparityErrorConfig config_;
  std::uint64_t seed_;
  std::vector<float> noise_;  // tile of noise, kNoiseSide squared, standard deviation 1
};

}  // namespace rover
