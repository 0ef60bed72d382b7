// Simulated stereo camera. Images depend on configuration, seed, surface, pose and frame number and, through exposure
// control, on the previous image.
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
  TileSceneConfig scene;  // only for a camera that owns its scene
};

// Why this rig cannot be rendered; empty if it can.
std::string problem_of_rendering(const StereoRig& rig);

class StereoCameraSim {
 public:
  // `seed`: calibration error and noise; the ground texture uses the scene's seed.
  StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config, const Surface& surface, std::uint64_t seed);
  // Shares a scene with other cameras.
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

  // Range along each pixel's ray, infinite without a hit, row-major.
  std::vector<float> left_ranges_m(const Eigen::Isometry3d& T_map_left);

  const StereoRig& true_rig() const { return rig_; }
  TileScene& scene() { return *scene_; }

 private:
  struct CameraModel {
    RayTable rays;
    Imager imager;
    RadianceImage radiance;
  };
  CameraView view_from(const CameraModel& eye, const Eigen::Isometry3d& T_map_cam) const;
  void trace_radiance(const Eigen::Isometry3d& T_map_left);
  CameraModel make_camera(const PinholeCamera& camera) const;

  CameraSimConfig config_;
  StereoRig rig_;
  std::uint64_t seed_;
  std::shared_ptr<TileScene> scene_;
  CameraModel left_;
  CameraModel right_;
  double exposure_s_ = 0.0;  // of the next image; 0: metered from the scene
};

}  // namespace rover
