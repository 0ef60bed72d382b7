// Simulated stereo clouds of an analytic ground: ray casting to the first surface (rocks occlude) and disparity noise.
#pragma once

#include <cmath>
#include <functional>

#include "rover_simulator/world/noise.hpp"
#include "slam/cloud.hpp"
#include "slam/random.hpp"

namespace rover::slam::testing_support {

struct NavcamModel {
  double focal_px = 818.0;
  double baseline_m = 0.24;
  int width_px = 640, height_px = 480;
  int step_px = 4;  // one ray per step
  double near_m = 1.0, far_m = 12.0;
  double disparity_sigma_px = 0.25;
  double disparity_offset_px = 0.0;  // calibration error
  double pitch_down_rad = to_rad(17.0);
  double pan_rad = 0.0;  // positive to the left
  Eigen::Vector3d p_body_cam = {0.45, 0.12, 0.48};

  Eigen::Isometry3d T_body_cam() const { return make_pose(camera_rotation(pitch_down_rad, 0.0, pan_rad), p_body_cam); }
};

// Depth along the optical axis of the first ground point; NaN: none in range.
template <class Height>
double depth_of(const Height& height_m, const Eigen::Vector3d& from, const Eigen::Vector3d& ray, double far_m) {
  double t = 0.5, before = t;
  for (; t < far_m;) {
    const Eigen::Vector3d p = from + t * ray;
    const double clear = p.z() - height_m(p.x(), p.y());
    if (clear <= 0.0) break;
    before = t;
    t += std::max(0.02, 0.4 * clear);
  }
  if (t >= far_m) return kNaN;
  for (int i = 0; i < 8; ++i) {
    const double middle = 0.5 * (before + t);
    const Eigen::Vector3d p = from + middle * ray;
    (p.z() > height_m(p.x(), p.y()) ? before : t) = middle;
  }
  return 0.5 * (before + t);
}

template <class Height>
Cloud cloud_of(const Height& height_m, const Eigen::Isometry3d& T_world_body, const NavcamModel& camera, Random& random,
               Utime utime) {
  Cloud cloud;
  cloud.utime = utime;
  cloud.T_body_cam = camera.T_body_cam();
  const Eigen::Isometry3d T_world_cam = T_world_body * cloud.T_body_cam;
  const double fb = camera.focal_px * camera.baseline_m;
  for (int row = camera.step_px / 2; row < camera.height_px; row += camera.step_px)
    for (int column = camera.step_px / 2; column < camera.width_px; column += camera.step_px) {
      const Eigen::Vector3d ray((column - 0.5 * camera.width_px) / camera.focal_px,
                                (row - 0.5 * camera.height_px) / camera.focal_px, 1.0);
      const double z = depth_of(height_m, T_world_cam.translation(), T_world_cam.linear() * ray, camera.far_m + 0.5);
      if (std::isnan(z)) continue;
      const double disparity = fb / z + camera.disparity_sigma_px * random.gauss() + camera.disparity_offset_px;
      const double measured = fb / disparity;
      if (!(measured > camera.near_m && measured < camera.far_m)) continue;
      cloud.points.push_back(
          {(ray * measured).cast<float>(), static_cast<float>(measured * measured * camera.disparity_sigma_px / fb)});
    }
  return cloud;
}

// Terrain with features: waves and half-sunk spheres on a grid. Planar if `relief` and `ridge_m` are 0.
struct Ground {
  double relief = 1.0;
  double slope_x = 0.0;
  double ridge_m = 0.0;  // height of ridges along y

  double operator()(double x, double y) const {
    if (relief == 0.0) return slope_x * x + ridge_m * std::sin(3.0 * x);
    double z = slope_x * x + relief * (0.12 * std::sin(0.9 * x + 0.4 * y) + 0.10 * std::sin(0.5 * y - 0.7 * x + 1.0) +
                                       0.02 * std::sin(4.1 * x) * std::cos(3.3 * y));
    return z + relief * rock(x, y);
  }

 private:
  static double rock(double x, double y) {
    const int ix = static_cast<int>(std::floor(x / 1.5)), iy = static_cast<int>(std::floor(y / 1.5));
    HashStream random(hash_cell(1, ix, iy));
    if (random.unit() > 0.5) return 0.0;
    const double radius = 0.12 + 0.25 * random.unit();
    const double cx = 1.5 * ix + 0.4 + 0.7 * random.unit(), cy = 1.5 * iy + 0.4 + 0.7 * random.unit();
    const double off2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
    return off2 < radius * radius ? 0.9 * std::sqrt(radius * radius - off2) : 0.0;
  }
};

// Height of the body origin above the ground, with the rover upright.
constexpr double kOriginHeightM = 0.62;
inline Eigen::Isometry3d upright(const Pose2& pose, double z_m) {
  Eigen::Isometry3d T = from_planar(pose);
  T.translation().z() = z_m;
  return T;
}

}  // namespace rover::slam::testing_support
