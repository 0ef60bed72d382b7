#include "rover_simulator/camera/ray_table.hpp"

#include <cmath>

namespace rover {
namespace {

Eigen::Vector2d distort(const PinholeCamera& camera, const Eigen::Vector2d& p) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

}  // namespace

Eigen::Vector2d project(const PinholeCamera& camera, const Eigen::Vector3d& direction) {
  const Eigen::Vector2d p = distort(camera, direction.head<2>() / direction.z());
  return {camera.fx_px * p.x() + camera.cx_px, camera.fy_px * p.y() + camera.cy_px};
}

Eigen::Vector3d ray_of_pixel(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d target((pixel.x() - camera.cx_px) / camera.fx_px, (pixel.y() - camera.cy_px) / camera.fy_px);
  Eigen::Vector2d p = target;
  // Fixed point iteration; lenses of our kind (distortion of a few percent) gain a digit or more a round.
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d step = target - distort(camera, p);
    p += step;
    if (step.squaredNorm() < 1e-22) break;
  }
  return {p.x(), p.y(), 1.0};
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
