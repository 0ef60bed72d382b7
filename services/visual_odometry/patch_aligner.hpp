// Sub-pixel alignment of a small image patch: inverse compositional Lucas-Kanade (Baker & Matthews, IJCV 2004) on
// patches of zero mean and unit norm, so that neither exposure nor offset matters. The template is sampled through an
// affine warp, which foretells how the patch looks from the new place; what is left to find is a shift.
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
  std::array<float, kPatchArea> gx;     // derivative of `value` by a shift of the sampled window
  std::array<float, kPatchArea> gy;
  Eigen::Matrix2f H_inv;
};

struct Alignment {
  bool ok = false;
  Eigen::Vector2f position = Eigen::Vector2f::Zero();
  float score = 0.0F;  // zero-mean normalised cross-correlation in [-1, 1]
};

// Samples the window about `center`; `A_source_target` takes offsets in the image to be searched into offsets here.
// False where the window leaves the image or has no texture in some direction.
bool make_patch(const cv::Mat& image, const Eigen::Vector2f& center, const Eigen::Matrix2f& A_source_target,
                Patch& patch);

// Finds the patch near `guess`. Fails where it leaves the image, moves further than `max_shift_px` or does not settle.
Alignment align(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& guess, float max_shift_px);

// Correlation of the patch with the window at `position`; -1 where the window leaves the image or is flat.
float correlation(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& position);

}  // namespace rover::vo
