#include "rover_simulator/camera/ray_table.hpp"

#include <algorithm>
#include <cmath>

namespace rover {
namespace {

constexpr double kMaxAngleRad = 1.4;  // [rad] from the axis; rays (x, y, 1) diverge towards 90 deg

// Fisheye model with k1 k2 k3 k4 (Kannala and Brandt 2006).
double fisheye_angle(const PinholeCamera& camera, double angle) {
  const auto& k = camera.distortion;
  const double a2 = angle * angle;
  return angle * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
}

Eigen::Vector2d distort(const PinholeCamera& camera, const Eigen::Vector2d& p) {
  if (camera.model == DistortionModel::kEquidistant) {
    const double radius = p.norm();
    return radius > 0.0 ? Eigen::Vector2d(p * (fisheye_angle(camera, std::atan(radius)) / radius)) : p;
  }
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Eigen::Vector3d fisheye_ray(const PinholeCamera& camera, const Eigen::Vector2d& target) {
  const double in_picture = target.norm();
  if (in_picture == 0.0) return Eigen::Vector3d::UnitZ();
  double angle = in_picture;
  for (int i = 0; i < 30; ++i) angle = std::clamp(angle + in_picture - fisheye_angle(camera, angle), 0.0, kMaxAngleRad);
  const double scale = std::tan(angle) / in_picture;
  return {target.x() * scale, target.y() * scale, 1.0};
}

}  // namespace

Eigen::Vector2d project(const PinholeCamera& camera, const Eigen::Vector3d& direction) {
  const Eigen::Vector2d p = distort(camera, direction.head<2>() / direction.z());
  return {camera.fx_px * p.x() + camera.cx_px, camera.fy_px * p.y() + camera.cy_px};
}

Eigen::Vector3d ray_of_pixel(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d target((pixel.x() - camera.cx_px) / camera.fx_px, (pixel.y() - camera.cy_px) / camera.fy_px);
  if (camera.model == DistortionModel::kEquidistant) return fisheye_ray(camera, target);
  Eigen::Vector2d p = target;
  // Fixed-point iteration; gains at least a digit per round at distortions of a few percent.
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d step = target - distort(camera, p);
    p += step;
    if (step.squaredNorm() < 1e-22) break;
  }
  return {p.x(), p.y(), 1.0};
}

bool has_ray(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  return (project(camera, ray_of_pixel(camera, pixel)) - pixel).norm() < 1e-3;
}

RayTable make_ray_table(const PinholeCamera& camera, int width, int height) {
  RayTable table;
  table.width = width;
  table.height = height;
  table.stride = width + 1;
  table.pixel_angle_rad = static_cast<float>(1.0 / camera.fx_px);
  table.x.reserve(static_cast<size_t>(width + 1) * (height + 1));
  table.y.reserve(static_cast<size_t>(width + 1) * (height + 1));
  for (int v = 0; v <= height; ++v) {
    for (int u = 0; u <= width; ++u) {
      const Eigen::Vector3d ray = ray_of_pixel(camera, {u, v});
      table.x.push_back(static_cast<float>(ray.x()));
      table.y.push_back(static_cast<float>(ray.y()));
    }
  }
  return table;
}

}  // namespace rover
