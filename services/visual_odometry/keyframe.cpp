#include "visual_odometry/keyframe.hpp"

namespace rover::vo {

Keyframe make_keyframe(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                       const StereoCamera& camera, const CornerConfig& corners, const StereoMatchConfig& stereo,
                       const DisparityCorrection& correction) {
  Keyframe key{left, camera, correction, {}};
  for (const Eigen::Vector2f& corner : detect_corners(left.base(), corners)) {
    const auto match = match_corner(left, right, seed, corner, stereo);
    if (!match) continue;
    const double disparity = match->disparity_px + correction.px(camera, corner.x(), corner.y());
    if (disparity < stereo.min_disparity_px) continue;
    key.points.push_back(
        {corner, disparity, match->row_offset_px, match->gradient, camera.point(corner.x(), corner.y(), disparity)});
  }
  return key;
}

}  // namespace rover::vo
