// Disparity of a stereo camera without images: each rectified pixel's ray is traced to the ground and projected with
// the true cameras, so the errors of calibration are included.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/camera_rig.hpp"
#include "common/core/image.hpp"
#include "rover_simulator/camera/ray_table.hpp"
#include "rover_simulator/camera/tile_scene.hpp"

namespace rover {

class GeometricStereo {
 public:
  // `nominal`: the rig that is rectified to `rectified`. The scene need not be shaded.
  GeometricStereo(const StereoRig& nominal, const StereoRig& true_rig, const StereoCamera& rectified,
                  std::shared_ptr<TileScene> scene);

  int width() const { return rectified_.width; }
  int height() const { return rectified_.height; }
  // Disparity of each rectified left pixel [px], 0 without ground. T_map_left: the true left camera.
  std::vector<float> exact_px(const Eigen::Isometry3d& T_map_left);
  // Point in the true left camera of an even pixel with its exact disparity.
  Eigen::Vector3d point(int u, int v, double exact_px) const;

 private:
  // Disparity = at_infinity_px + baseline_px_m / depth: linear in the inverse depth along the true optical axis.
  struct Projection {
    float at_infinity_px;
    float baseline_px_m;
    float range_per_depth;
  };

  std::vector<float> trace(const Eigen::Isometry3d& T_map_left);

  StereoCamera rectified_;
  std::shared_ptr<TileScene> scene_;
  RayTable rays_;  // in the true left camera; fewer than pixels
  std::vector<Projection> projections_;
};

}  // namespace rover
