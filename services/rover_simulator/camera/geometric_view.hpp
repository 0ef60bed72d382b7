// The geometric tier of perception: disparities of LocCam and NavCam from one unshaded scene, with the texture of the
// ground that images would show.
#pragma once

#include <memory>

#include "common/stereo/stereo.hpp"
#include "rover_simulator/camera/disparity_errors.hpp"
#include "rover_simulator/camera/geometric_stereo.hpp"

namespace rover {

class GeometricView {
 public:
  // The world outlives it.
  GeometricView(const Surface& world, const GroundAppearanceConfig& appearance);

  std::shared_ptr<TileScene> scene() const { return scene_; }
  // What matching would measure, searching about `reference`. T_map_left: the true left camera.
  Disparity expose(GeometricStereo& stereo, const DisparityErrors& errors, const DisparityPlane& reference,
                   const Eigen::Isometry3d& T_map_left, std::int64_t frame);

 private:
  bool textured(const Eigen::Vector3d& p_map) const;

  const Surface& world_;
  GroundAppearance appearance_;
  std::shared_ptr<TileScene> scene_;
};

DisparityErrorConfig errors_of(const stereo::MatcherConfig& matcher, const StereoCamera& rectified);
// Disparity of the ground under the rover.
DisparityPlane ground_reference(const StereoCamera& rectified, double origin_height_m);

}  // namespace rover
