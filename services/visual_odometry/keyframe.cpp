#include "visual_odometry/keyframe.hpp"

namespace rover::vo {

Keyframe make_keyframe(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                       const StereoCamera& camera, const CornerConfig& corners, const StereoMatchConfig& stereo) {
  Keyframe key{left, camera, {}};
  for (const Eigen::Vector2f& corner : detect_corners(left.base(), corners)) {
    const auto match = match_corner(left, right, seed, corner, stereo);
    if (!match) continue;
    key.points.push_back(
        {corner, match->disparity_px, match->gradient, camera.point(corner.x(), corner.y(), match->disparity_px)});
  }
  return key;
}

}  // namespace rover::vo
