// Sub-pixel stereo matching of corners. The dense disparity gives the initial value and its gradient; without it, the
// corner is first searched along its row in a small image.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/core/image.hpp"
#include "visual_odometry/image_pyramid.hpp"

namespace rover::vo {

struct StereoMatchConfig {
  double min_disparity_px = 1.0;
  double max_disparity_px = 160.0;  // LocCam: ground 0.31 m away
  double min_score = 0.80;          // correlation of the two patches
  double max_row_offset_px = 1.5;   // residual of rectification
  double max_seed_offset_px = 2.0;  // between the dense disparity and the refined one
  bool search_without_seed = true;
};

struct StereoMatch {
  double disparity_px = 0.0;
  double row_offset_px = 0.0;                          // row in the right image - row in the left image
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  // of the disparity by u and v
};

// `seed`: dense disparity, may be null.
std::optional<StereoMatch> match_corner(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                                        const Eigen::Vector2f& corner, const StereoMatchConfig& config);

}  // namespace rover::vo
