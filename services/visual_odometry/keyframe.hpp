// The frame against which the following ones are tracked: its left image and the corners whose place in space the
// pair gave.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/core/image.hpp"
#include "visual_odometry/corner_detector.hpp"
#include "visual_odometry/image_pyramid.hpp"
#include "visual_odometry/stereo_matcher.hpp"

namespace rover::vo {

struct KeyPoint {
  Eigen::Vector2f pixel;
  double disparity_px;  // calibration's offset removed
  Eigen::Vector2d disparity_gradient;
  Eigen::Vector3d p_key;  // in the keyframe's camera axes
};

struct Keyframe {
  ImagePyramid left;
  StereoCamera camera;
  std::vector<KeyPoint> points;
};

// `seed` may be null: the dense disparity of the pair. `offset_px` is added to what is measured.
Keyframe make_keyframe(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                       const StereoCamera& camera, const CornerConfig& corners, const StereoMatchConfig& stereo,
                       double offset_px);

}  // namespace rover::vo
