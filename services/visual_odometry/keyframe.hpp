// Reference frame for tracking: left image and corners triangulated from the stereo pair.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/core/image.hpp"
#include "visual_odometry/corner_detector.hpp"
#include "visual_odometry/image_pyramid.hpp"
#include "visual_odometry/stereo_matcher.hpp"

namespace rover::vo {

// In half image widths from the centre.
inline Eigen::Vector2d image_position(const StereoCamera& camera, double u, double v) {
  return Eigen::Vector2d(u - camera.cx_px, v - camera.cy_px) / (0.5 * camera.width);
}

// Estimated error of the calibration, to be added to measured disparities; see epipolar_calibration.hpp.
struct DisparityCorrection {
  double yaw_px = 0.0;
  double roll_px = 0.0;
  double focal_px = 0.0;

  double px(const StereoCamera& camera, double u, double v) const {
    const Eigen::Vector2d at = image_position(camera, u, v);
    return yaw_px + focal_px * at.x() - roll_px * at.y();
  }
};

struct KeyPoint {
  Eigen::Vector2f pixel;
  double disparity_px;  // corrected
  double row_offset_px;
  Eigen::Vector2d disparity_gradient;
  Eigen::Vector3d p_key;  // in the keyframe's camera axes
};

struct Keyframe {
  ImagePyramid left;
  StereoCamera camera;
  DisparityCorrection correction;  // constant for a keyframe, so that its motions telescope
  std::vector<KeyPoint> points;
};

// `seed`: dense disparity of the pair, may be null.
Keyframe make_keyframe(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                       const StereoCamera& camera, const CornerConfig& corners, const StereoMatchConfig& stereo,
                       const DisparityCorrection& correction);

}  // namespace rover::vo
