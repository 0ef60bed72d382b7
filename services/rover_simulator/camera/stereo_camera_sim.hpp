// A stereo camera in the simulated world. Pictures are a function of configuration, seed, surface, pose and frame
// number, and, through the exposure control, of the picture before.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/core/camera_rig.hpp"
#include "common/core/image.hpp"
#include "rover_simulator/camera/hit_band.hpp"
#include "rover_simulator/camera/imager.hpp"
#include "rover_simulator/camera/ray_table.hpp"
#include "rover_simulator/camera/tile_scene.hpp"

namespace rover {

struct CameraSimConfig {
  double calibration_error_px = 0.2;  // rms; see calibration_error.hpp
  ImagerConfig imager;
  TileSceneConfig scene;  // only for the camera that makes a scene of its own
};

// Why no picture of such a camera can be made; empty: it can.
std::string problem_of_rendering(const StereoRig& rig);

class StereoCameraSim {
 public:
  // The seed draws calibration error and noise; the ground's texture comes from the scene's seed.
  StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config, const Surface& surface, std::uint64_t seed);
  // With a scene that several cameras share.
  StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config, std::shared_ptr<TileScene> scene,
                  std::uint64_t seed);

  struct Pair {
    GrayImage left;
    GrayImage right;
    double exposure_s = 0.0;
  };
  Pair render(const Eigen::Isometry3d& T_map_body, std::int64_t frame);
  // For a camera on a pan-tilt unit: the left camera's pose (camera axes).
  Pair render_from(const Eigen::Isometry3d& T_map_left, std::int64_t frame);

  // Distance along each pixel's ray; infinite where it meets no ground. Rows from the top.
  std::vector<float> left_ranges_m(const Eigen::Isometry3d& T_map_left);

  const StereoRig& true_rig() const { return rig_; }
  TileScene& scene() { return *scene_; }

 private:
  struct Eye {
    RayTable rays;
    Imager imager;
    RadianceImage radiance;
  };
  CameraView view_from(const Eye& eye, const Eigen::Isometry3d& T_map_cam) const;
  void trace_radiance(const Eigen::Isometry3d& T_map_left);
  Eye make_eye(const PinholeCamera& camera) const;

  CameraSimConfig config_;
  StereoRig rig_;
  std::uint64_t seed_;
  std::shared_ptr<TileScene> scene_;
  Eye left_;
  Eye right_;
  double exposure_s_ = 0.0;  // for the next image; 0: none yet, the scene is metered
};

}  // namespace rover
