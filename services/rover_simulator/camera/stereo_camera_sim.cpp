#include "rover_simulator/camera/stereo_camera_sim.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "common/core/check.hpp"
#include "common/core/frames.hpp"
#include "rover_simulator/camera/calibration_error.hpp"
#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

// Disparity tolerance of interpolated rays.
constexpr double kDisparityTolerance_px = 0.06;

void shade_band(const TileScene& scene, const CameraView& camera, const HitBand& band, std::vector<float>& radiance) {
  const int width = camera.rays.width;
  for (int row = 0; row < HitBand::kRows; ++row) {
    for (int u = 0; u < width; u += kPacket) {
      RayPacket rays;
      Lanes<int> tile;
      Lanes<float> range_m;
      for (int k = 0; k < kPacket; ++k) {
        set_viewing_ray(camera, u + k, band.first_row + row, k, rays);
        tile[k] = band.tile[static_cast<size_t>(row) * width + u + k];
        range_m[k] = band.range_m[static_cast<size_t>(row) * width + u + k];
      }
      const Lanes<float> light = scene.radiance(camera.view, rays, tile, range_m, camera.rays.pixel_angle_rad);
      std::copy_n(light.lane, kPacket, &radiance[static_cast<size_t>(band.first_row + row) * width + u]);
    }
  }
}

}  // namespace

std::string problem_of_rendering(const StereoRig& rig) {
  if (rig.width % (2 * kPacket) != 0 || rig.height % HitBand::kRows != 0)
    return "the simulator renders widths that are multiples of " + std::to_string(2 * kPacket) + " px and heights of " +
           std::to_string(HitBand::kRows) + " px";
  for (const PinholeCamera& camera : {rig.left, rig.right})
    for (const int u : {0, rig.width})
      for (const int v : {0, rig.height})
        if (!has_ray(camera, {u, v}))
          return "the simulator renders up to 80 deg from the axis; the picture's corners are beyond, or the "
                 "distortion folds them";
  return {};
}

StereoCameraSim::StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config, const Surface& surface,
                                 std::uint64_t seed)
    : StereoCameraSim(nominal, config, std::make_shared<TileScene>(surface, config.scene), seed) {}

StereoCameraSim::StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config,
                                 std::shared_ptr<TileScene> scene, std::uint64_t seed)
    : config_(config),
      rig_(with_calibration_error(nominal, config.calibration_error_px, seed)),
      seed_(seed),
      scene_(std::move(scene)),
      left_(make_camera(rig_.left)),
      right_(make_camera(rig_.right)) {
  ROVER_CHECK(problem_of_rendering(rig_).empty(), rig_.width, rig_.height);
}

StereoCameraSim::CameraModel StereoCameraSim::make_camera(const PinholeCamera& camera) const {
  return {make_ray_table(camera, rig_.width, rig_.height), Imager(config_.imager, rig_.width, rig_.height),
          RadianceImage(rig_.width, rig_.height)};
}

StereoCameraSim::Pair StereoCameraSim::render(const Eigen::Isometry3d& T_map_body, std::int64_t frame) {
  return render_from(T_map_body * rig_.T_body_left, frame);
}

StereoCameraSim::Pair StereoCameraSim::render_from(const Eigen::Isometry3d& T_map_left, std::int64_t frame) {
  ROVER_CHECK(is_finite(T_map_left));
  trace_radiance(T_map_left);
  if (exposure_s_ == 0.0) exposure_s_ = metered_exposure_s(config_.imager, left_.radiance);

  Pair pair{GrayImage(rig_.width, rig_.height), GrayImage(rig_.width, rig_.height), exposure_s_};
  const std::uint64_t frame_key = hash64(seed_, static_cast<std::uint64_t>(frame));
  const int jobs = rig_.height / HitBand::kRows;
  scene_->pool().run(2 * jobs, [&](int job) {
    const CameraModel& eye = job < jobs ? left_ : right_;
    GrayImage& image = job < jobs ? pair.left : pair.right;
    const std::uint64_t key = hash64(frame_key, job < jobs ? 0 : 1);
    const int first = job % jobs * HitBand::kRows;
    for (int v = first; v < first + HitBand::kRows; ++v)
      eye.imager.expose_row(eye.radiance, pair.exposure_s, key, v, image);
  });
  exposure_s_ = next_exposure_s(config_.imager, exposure_s_, mean_grey(pair.left));
  return pair;
}

CameraView StereoCameraSim::view_from(const CameraModel& eye, const Eigen::Isometry3d& T_map_cam) const {
  const double baseline_m = rig_.T_left_right.translation().norm();
  const double tolerance = kDisparityTolerance_px / (rig_.left.fx_px * baseline_m);
  return {eye.rays, T_map_cam.linear().cast<float>(), scene_->view(T_map_cam.translation()),
          static_cast<float>(tolerance)};
}

void StereoCameraSim::trace_radiance(const Eigen::Isometry3d& T_map_left) {
  scene_->focus(T_map_left.translation().x(), T_map_left.translation().y());
  const CameraView left = view_from(left_, T_map_left);
  const CameraView right = view_from(right_, T_map_left * rig_.T_left_right);
  const int bands = rig_.height / HitBand::kRows;
  scene_->pool().run(2 * bands, [&](int job) {
    const CameraView& camera = job < bands ? left : right;
    const HitBand band = find_hits(*scene_, camera, job % bands * HitBand::kRows);
    shade_band(*scene_, camera, band, job < bands ? left_.radiance.data : right_.radiance.data);
  });
}

std::vector<float> StereoCameraSim::left_ranges_m(const Eigen::Isometry3d& T_map_left) {
  scene_->focus(T_map_left.translation().x(), T_map_left.translation().y());
  const CameraView left = view_from(left_, T_map_left);
  std::vector<float> ranges(static_cast<size_t>(rig_.width) * rig_.height);
  scene_->pool().run(rig_.height / HitBand::kRows, [&](int job) {
    const HitBand band = find_hits(*scene_, left, job * HitBand::kRows);
    std::copy(band.range_m.begin(), band.range_m.end(), ranges.begin() + std::ptrdiff_t{band.first_row} * rig_.width);
  });
  return ranges;
}

}  // namespace rover
