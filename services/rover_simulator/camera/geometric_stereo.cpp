#include "rover_simulator/camera/geometric_stereo.hpp"

#include <algorithm>
#include <cmath>

#include "rover_simulator/camera/hit_band.hpp"

namespace rover {
namespace {

// Depths between which the disparity is interpolated; the error is below 0.01 px beyond 0.5 m.
constexpr double kNearM = 1.0;
constexpr double kFarM = 20.0;
constexpr double kDisparityTolerance_px = 0.5;  // of interpolated rays; the noise of matching is larger
constexpr int kRayPx = 2;                       // rays at every second pixel of every second row
constexpr float kSurfacePx = 1.0F;              // neighbours on one surface differ by less

// Disparity half-way between two rays: their mean on one surface, else the first. 0: no ground.
float between(float a, float b) {
  return a > 0.0F && b > 0.0F && std::abs(a - b) < kSurfacePx ? 0.5F * (a + b) : a;
}

// From the true cameras to the rectified ones and back.
class Projector {
 public:
  Projector(const StereoRig& nominal, const StereoRig& true_rig, const StereoCamera& rectified)
      : nominal_(nominal),
        true_(true_rig),
        camera_(rectified),
        R_left_rectified_(nominal.T_body_left.linear().transpose() * rectified.T_body_cam.linear()),
        R_rectified_right_(R_left_rectified_.transpose() * nominal.T_left_right.linear()),
        T_right_left_(true_rig.T_left_right.inverse()) {}

  Eigen::Vector3d true_ray(double u, double v) const {
    const Eigen::Vector3d rectified((u - camera_.cx_px) / camera_.focal_px, (v - camera_.cy_px) / camera_.focal_px, 1);
    const Eigen::Vector3d left = R_left_rectified_ * rectified;
    return ray_of_pixel(true_.left, project(nominal_.left, left));
  }

  double disparity_px(double u, const Eigen::Vector3d& p_left) const {
    const Eigen::Vector2d pixel = project(true_.right, T_right_left_ * p_left);
    const Eigen::Vector3d ray = R_rectified_right_ * ray_of_pixel(nominal_.right, pixel);
    return u - (camera_.cx_px + camera_.focal_px * ray.x() / ray.z());
  }

 private:
  const StereoRig& nominal_;
  const StereoRig& true_;
  const StereoCamera& camera_;
  Eigen::Matrix3d R_left_rectified_;
  Eigen::Matrix3d R_rectified_right_;
  Eigen::Isometry3d T_right_left_;
};

}  // namespace

GeometricStereo::GeometricStereo(const StereoRig& nominal, const StereoRig& true_rig, const StereoCamera& rectified,
                                 std::shared_ptr<TileScene> scene)
    : rectified_(rectified), scene_(std::move(scene)) {
  const Projector projector(nominal, true_rig, rectified);
  rays_.width = rectified.width / kRayPx;
  rays_.height = (rectified.height / kRayPx + HitBand::kRows - 1) / HitBand::kRows * HitBand::kRows;
  rays_.stride = rays_.width + 1;
  rays_.pixel_angle_rad = static_cast<float>(kRayPx / rectified.focal_px);
  for (int row = 0; row <= rays_.height; ++row) {
    for (int column = 0; column <= rays_.width; ++column) {
      const double u = kRayPx * column;
      const Eigen::Vector3d ray = projector.true_ray(u, kRayPx * row);
      rays_.x.push_back(static_cast<float>(ray.x()));
      rays_.y.push_back(static_cast<float>(ray.y()));
      const double near_px = projector.disparity_px(u, ray * kNearM);
      const double far_px = projector.disparity_px(u, ray * kFarM);
      const double baseline_px_m = (near_px - far_px) / (1.0 / kNearM - 1.0 / kFarM);
      projections_.push_back({static_cast<float>(far_px - baseline_px_m / kFarM), static_cast<float>(baseline_px_m),
                              static_cast<float>(ray.norm())});
    }
  }
}

std::vector<float> GeometricStereo::trace(const Eigen::Isometry3d& T_map_left) {
  scene_->focus(T_map_left.translation().x(), T_map_left.translation().y());
  const double tolerance = kDisparityTolerance_px / (rectified_.focal_px * rectified_.baseline_m);
  const CameraView view{rays_, T_map_left.linear().cast<float>(), scene_->view(T_map_left.translation()),
                        static_cast<float>(tolerance)};
  std::vector<float> traced_px(static_cast<size_t>(rays_.width) * rays_.height, 0.0F);
  for (int first = 0; first < rays_.height; first += HitBand::kRows) {
    const HitBand band = find_hits(*scene_, view, first);
    for (int row = 0; row < HitBand::kRows; ++row)
      for (int column = 0; column < rays_.width; ++column) {
        const size_t at = static_cast<size_t>(row) * rays_.width + column;
        if (band.tile[at] == kNoTile) continue;
        const Projection& p = projections_[static_cast<size_t>(first + row) * rays_.stride + column];
        const float px = p.at_infinity_px + p.baseline_px_m * p.range_per_depth / band.range_m[at];
        traced_px[static_cast<size_t>(first) * rays_.width + at] = std::max(px, 0.0F);
      }
  }
  return traced_px;
}

std::vector<float> GeometricStereo::exact_px(const Eigen::Isometry3d& T_map_left) {
  const std::vector<float> traced_px = trace(T_map_left);
  const int width = rectified_.width;
  std::vector<float> px(static_cast<size_t>(width) * rectified_.height);
  const auto row_of = [&](int v) { return px.begin() + std::ptrdiff_t{v} * width; };
  for (int v = 0; v < rectified_.height; v += kRayPx) {
    const float* rays = &traced_px[static_cast<size_t>(v / kRayPx) * rays_.width];
    for (int column = 0; column < rays_.width; ++column) {
      row_of(v)[kRayPx * column] = rays[column];
      row_of(v)[kRayPx * column + 1] = between(rays[column], rays[std::min(column + 1, rays_.width - 1)]);
    }
  }
  for (int v = 1; v < rectified_.height; v += kRayPx) {
    const int below = std::min(v + 1, rectified_.height - kRayPx);
    std::transform(row_of(v - 1), row_of(v - 1) + width, row_of(below), row_of(v), between);
  }
  return px;
}

Eigen::Vector3d GeometricStereo::point(int u, int v, double exact_px) const {
  const size_t at = static_cast<size_t>(v / kRayPx) * rays_.stride + u / kRayPx;
  const double depth_m = projections_[at].baseline_px_m / (exact_px - projections_[at].at_infinity_px);
  return depth_m * Eigen::Vector3d(rays_.x[at], rays_.y[at], 1.0);
}

}  // namespace rover
