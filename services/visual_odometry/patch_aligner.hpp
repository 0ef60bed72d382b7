// Sub-pixel alignment of a small image patch: inverse compositional Lucas-Kanade (Baker & Matthews, IJCV 2004) on
// zero-mean, unit-norm patches, invariant to gain and offset of the exposure. The template is sampled through the
// predicted affine warp, so only a translation remains to be estimated.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace rover::vo {

constexpr int kPatchRadius = 6;
constexpr int kPatchSide = 2 * kPatchRadius + 1;
constexpr int kPatchArea = kPatchSide * kPatchSide;

struct Patch {
  std::array<float, kPatchArea> value;  // zero mean, unit norm
  std::array<float, kPatchArea> gx;     // derivative of `value` by a translation of the sampled window
  std::array<float, kPatchArea> gy;
  Eigen::Matrix2f H_inv;
};

struct Alignment {
  bool ok = false;
  Eigen::Vector2f position = Eigen::Vector2f::Zero();
  float score = 0.0F;  // zero-mean normalised cross-correlation in [-1, 1]
};

// Samples the window about `center`; `A_source_target` maps offsets in the target image to offsets in `image`.
// False if the window leaves the image or lacks texture in some direction.
bool make_patch(const cv::Mat& image, const Eigen::Vector2f& center, const Eigen::Matrix2f& A_source_target,
                Patch& patch);

// Aligns the patch near `guess`. Fails if it leaves the image, moves beyond `max_shift_px` or does not converge.
Alignment align(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& guess, float max_shift_px);

// Correlation of the patch with the window at `position`; -1 if the window leaves the image or is flat.
float correlation(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& position);

}  // namespace rover::vo
