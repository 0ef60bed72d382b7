#include "hazard_detector/disparity_table.hpp"

#include <algorithm>
#include <cmath>

namespace rover::hazard {
namespace {

// Distance to flat ground along the centre of row v [m]; infinity at and above the horizon.
double ground_ahead_m(const StereoCamera& camera, double height_m, double v) {
  const Eigen::Vector3d ray =
      camera.T_body_cam.linear() * Eigen::Vector3d(0.0, (v - camera.cy_px) / camera.focal_px, 1.0);
  return ray.z() < -1e-6 ? height_m * ray.x() / -ray.z() : std::numeric_limits<double>::infinity();
}

}  // namespace

DisparityTable::DisparityTable(const StereoCamera& camera, const HazardConfig& config)
    : camera_(camera),
      flat_ground_(disparity_plane(camera, {0, 0, -config.origin_height_m}, Eigen::Vector3d::UnitZ())),
      height_m_(camera.T_body_cam.translation().z() + config.origin_height_m) {
  const auto step = [&config](double pixels_per_cell) {
    return std::clamp(static_cast<int>(pixels_per_cell / config.samples_per_cell), 1, config.max_step_px);
  };
  for (int v = 0; v < camera.height;) {
    const double ahead_m = ground_ahead_m(camera, height_m_, v);
    const double row_m = ahead_m - ground_ahead_m(camera, height_m_, v + 1);
    const double depth_m = camera.depth_m(std::max(1e-3, flat_ground_.at(camera.cx_px, v)));
    const bool above_horizon = !std::isfinite(ahead_m);
    add_row(v, above_horizon ? 1 : step(config.grid.cell_m * camera.focal_px / depth_m), config);
    v += above_horizon ? 1 : step(config.grid.cell_m / row_m);
  }
}

void DisparityTable::add_row(int v, int step_u, const HazardConfig& config) {
  const Eigen::Vector3d& p_cam = camera_.T_body_cam.translation();
  for (int u = step_u / 2; u < camera_.width; u += step_u) {
    const Eigen::Vector3d ray =
        camera_.T_body_cam.linear() * camera_.point(u, v, camera_.focal_px * camera_.baseline_m);
    const double d_cal = flat_ground_.at(u, v);
    const double ahead_m = ray.z() < 0.0 ? -ray.x() * height_m_ / ray.z() : std::numeric_limits<double>::infinity();
    const double lateral_m = ray.z() < 0.0 ? p_cam.y() - ray.y() * height_m_ / ray.z() : 0.0;
    const bool in_roi = d_cal > 0.0 && u >= d_cal && ahead_m >= config.roi_near_m && ahead_m <= config.roi_far_m &&
                        std::abs(lateral_m) <= config.grid.half_width_m;
    samples_.push_back({v * camera_.width + u, static_cast<float>(u), static_cast<float>(v),
                        static_cast<float>(16.0 * d_cal), static_cast<float>(ray.x()), static_cast<float>(ray.y()),
                        static_cast<float>(ray.z()), in_roi});
  }
}

}  // namespace rover::hazard
