// Reference frame for tracking: left image and corners triangulated from the stereo pair.
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
  double disparity_px;  // with the estimated offset added
  Eigen::Vector2d disparity_gradient;
  Eigen::Vector3d p_key;  // in the keyframe's camera axes
};

struct Keyframe {
  ImagePyramid left;
  StereoCamera camera;
  std::vector<KeyPoint> points;
};

// `seed`: dense disparity of the pair, may be null. `offset_px` is added to each measured disparity.
Keyframe make_keyframe(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                       const StereoCamera& camera, const CornerConfig& corners, const StereoMatchConfig& stereo,
                       double offset_px);

}  // namespace rover::vo
