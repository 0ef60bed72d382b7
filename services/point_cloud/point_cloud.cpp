#include "point_cloud/point_cloud.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/core/check.hpp"

namespace rover::cloud {
namespace {

// Largest power of two up to `pixels`, 1 to 8.
int pixel_stride(double pixels) {
  return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::clamp(pixels, 1.0, 8.0))));
}

double valid_fraction(const Disparity& disparity) {
  const auto valid = std::count_if(disparity.px16.begin(), disparity.px16.end(), [](int px16) { return px16 > 0; });
  return static_cast<double>(valid) / static_cast<double>(disparity.px16.size());
}

}  // namespace

PointCloud::PointCloud(const PointCloudConfig& config, const StereoRig& rig, const PanTiltUnit& unit,
                       double ground_below_m)
    : config_(config), rig_(rig), unit_(unit), ground_below_m_(ground_below_m) {}

std::optional<CloudResult> PointCloud::step(const GrayImage& left, const GrayImage& right, double pan_rad,
                                            double tilt_rad, double exposure_s) {
  ROVER_CHECK(std::isfinite(pan_rad) && std::isfinite(tilt_rad), pan_rad, tilt_rad);
  auto stereo = stereo_at_tilt(tilt_rad).stereo.step(left, right);
  if (!stereo) return std::nullopt;
  return cloud_of(std::move(stereo->disparity), &stereo->left, exposure_s, pan_rad, tilt_rad);
}

CloudResult PointCloud::from_disparity(Disparity disparity, double pan_rad, double tilt_rad) {
  return cloud_of(std::move(disparity), nullptr, 0.0, pan_rad, tilt_rad);
}

CloudResult PointCloud::cloud_of(Disparity disparity, const GrayImage* left, double exposure_s, double pan_rad,
                                 double tilt_rad) {
  const TiltedStereo& tilted = stereo_at_tilt(tilt_rad);
  CloudResult result;
  result.valid_fraction = valid_fraction(disparity);
  remove_foreground_fattening(disparity, config_.foreground_fattening);
  result.cloud = filter_cloud(triangulate(disparity, tilted.stereo.camera(), left, exposure_s), config_.filter);
  result.T_body_cam = T_body_navcam(unit_, rig_.T_body_left, pan_rad, tilt_rad) * tilted.T_left_rectified;
  return result;
}

double PointCloud::sigma_m(double depth_m, const StereoCamera& camera) const {
  return config_.sigma_floor_m + depth_m * depth_m / (camera.focal_px * camera.baseline_m) * config_.sigma_disparity_px;
}

// Independent of pan: flat ground looks the same.
PointCloud::TiltedStereo& PointCloud::stereo_at_tilt(double tilt_rad) {
  const int step = static_cast<int>(std::lround(unit_.clamp_tilt(tilt_rad) / config_.tilt_step_rad));
  const auto found = stereo_by_tilt_.find(step);
  if (found != stereo_by_tilt_.end()) return found->second;
  StereoRig tilted = rig_;
  tilted.T_body_left = T_body_navcam(unit_, rig_.T_body_left, 0.0, step * config_.tilt_step_rad);
  stereo::Stereo stereo({.matcher = config_.matcher}, tilted, ground_below_m_);
  const Eigen::Isometry3d T_left_rectified = tilted.T_body_left.inverse() * stereo.camera().T_body_cam;
  return stereo_by_tilt_.emplace(step, TiltedStereo{std::move(stereo), T_left_rectified}).first->second;
}

// Subsamples pixels to `point_spacing_m` on a fronto-parallel surface; rows are four times as dense, as ground is seen
// at a grazing angle.
Cloud PointCloud::triangulate(const Disparity& disparity, const StereoCamera& camera, const GrayImage* left,
                              double exposure_s) const {
  const auto per_grey = static_cast<float>(exposure_s > 0.0 ? 1.0 / exposure_s : 1.0);
  Cloud cloud;
  for (int v = 0; v < disparity.height; ++v)
    for (int u = 0; u < disparity.width; ++u) {
      if (!disparity.valid(u, v)) continue;
      const double z = camera.depth_m(disparity.px(u, v));
      if (z < config_.min_depth_m || z > config_.max_depth_m) continue;
      const int stride = pixel_stride(config_.point_spacing_m * camera.focal_px / z);
      if (u % stride != 0 || v % std::max(1, stride / 4) != 0) continue;
      const Eigen::Vector3f p = camera.point(u, v, disparity.px(u, v)).cast<float>();
      cloud.push_back({p.x(), p.y(), p.z(), static_cast<float>(sigma_m(z, camera))});
      if (left != nullptr) cloud.back().brightness = per_grey * static_cast<float>(left->at(u, v));
    }
  return cloud;
}

}  // namespace rover::cloud
