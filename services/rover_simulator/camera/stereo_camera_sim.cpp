#include "rover_simulator/camera/stereo_camera_sim.hpp"

#include <cmath>
#include <utility>

#include "common/core/check.hpp"
#include "common/core/frames.hpp"
#include "rover_simulator/camera/calibration_error.hpp"
#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

// Packets are blocks of pixels, not strips: their rays stay together longer.
constexpr int kBlockWidth = 4;
constexpr int kBlockHeight = 2;
constexpr int kRowsPerJob = 8;
static_assert(kBlockWidth * kBlockHeight == kPacket && kRowsPerJob % kBlockHeight == 0);

void aim(const RayTable& rays, const Eigen::Matrix3f& R_map_cam, int u0, int v0, RayPacket& packet) {
  for (int k = 0; k < kPacket; ++k) {
    const size_t index = static_cast<size_t>(v0 + k / kBlockWidth) * rays.width + u0 + k % kBlockWidth;
    const float x = rays.x[index];
    const float y = rays.y[index];
    const float scale = 1.0F / std::sqrt(1.0F + x * x + y * y);
    packet.dir_x[k] = scale * (R_map_cam(0, 0) * x + R_map_cam(0, 1) * y + R_map_cam(0, 2));
    packet.dir_y[k] = scale * (R_map_cam(1, 0) * x + R_map_cam(1, 1) * y + R_map_cam(1, 2));
    packet.dir_z[k] = scale * (R_map_cam(2, 0) * x + R_map_cam(2, 1) * y + R_map_cam(2, 2));
    packet.pixel_m_per_m[k] = rays.pixel_angle_rad * scale;
  }
}

struct CameraView {
  const RayTable& rays;
  Eigen::Matrix3f R_map_cam;
  TileScene::View view;
};

CameraView view_from(const TileScene& scene, const RayTable& rays, const Eigen::Isometry3d& T_map_cam) {
  return {rays, T_map_cam.linear().cast<float>(), scene.view(T_map_cam.translation())};
}

// `trace` takes a packet of rays to one value each.
template <class Trace>
void trace_rows(const CameraView& camera, int first_row, const Trace& trace, std::vector<float>& out) {
  RayPacket rays;
  for (int v = first_row; v < first_row + kRowsPerJob; v += kBlockHeight) {
    for (int u = 0; u < camera.rays.width; u += kBlockWidth) {
      aim(camera.rays, camera.R_map_cam, u, v, rays);
      const Lanes<float> values = trace(rays);
      for (int k = 0; k < kPacket; ++k)
        out[static_cast<size_t>(v + k / kBlockWidth) * camera.rays.width + u + k % kBlockWidth] = values[k];
    }
  }
}

}  // namespace

StereoCameraSim::StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config, const Surface& surface,
                                 std::uint64_t seed)
    : StereoCameraSim(nominal, config, std::make_shared<TileScene>(surface, config.scene), seed) {}

StereoCameraSim::StereoCameraSim(const StereoRig& nominal, const CameraSimConfig& config,
                                 std::shared_ptr<TileScene> scene, std::uint64_t seed)
    : config_(config),
      rig_(with_calibration_error(nominal, config.calibration_error_px, seed)),
      seed_(seed),
      scene_(std::move(scene)),
      left_(make_eye(rig_.left)),
      right_(make_eye(rig_.right)) {
  ROVER_CHECK(rig_.width % kBlockWidth == 0 && rig_.height % kRowsPerJob == 0, rig_.width, rig_.height);
}

StereoCameraSim::Eye StereoCameraSim::make_eye(const PinholeCamera& camera) const {
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
  const int jobs = rig_.height / kRowsPerJob;
  scene_->pool().run(2 * jobs, [&](int job) {
    const Eye& eye = job < jobs ? left_ : right_;
    GrayImage& image = job < jobs ? pair.left : pair.right;
    const std::uint64_t key = hash64(frame_key, job < jobs ? 0 : 1);
    const int first = job % jobs * kRowsPerJob;
    for (int v = first; v < first + kRowsPerJob; ++v)
      eye.imager.expose_row(eye.radiance, pair.exposure_s, key, v, image);
  });
  exposure_s_ = next_exposure_s(config_.imager, exposure_s_, mean_grey(pair.left));
  return pair;
}

void StereoCameraSim::trace_radiance(const Eigen::Isometry3d& T_map_left) {
  scene_->focus(T_map_left.translation().x(), T_map_left.translation().y());
  const CameraView left = view_from(*scene_, left_.rays, T_map_left);
  const CameraView right = view_from(*scene_, right_.rays, T_map_left * rig_.T_left_right);
  const int jobs = rig_.height / kRowsPerJob;
  scene_->pool().run(2 * jobs, [&](int job) {
    const CameraView& camera = job < jobs ? left : right;
    trace_rows(
        camera, job % jobs * kRowsPerJob, [&](const RayPacket& rays) { return scene_->radiance(camera.view, rays); },
        job < jobs ? left_.radiance.data : right_.radiance.data);
  });
}

std::vector<float> StereoCameraSim::left_ranges_m(const Eigen::Isometry3d& T_map_left) {
  scene_->focus(T_map_left.translation().x(), T_map_left.translation().y());
  const CameraView left = view_from(*scene_, left_.rays, T_map_left);
  std::vector<float> ranges(static_cast<size_t>(rig_.width) * rig_.height);
  scene_->pool().run(rig_.height / kRowsPerJob, [&](int job) {
    trace_rows(
        left, job * kRowsPerJob, [&](const RayPacket& rays) { return scene_->ranges_m(left.view, rays); }, ranges);
  });
  return ranges;
}

}  // namespace rover
