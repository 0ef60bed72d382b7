#include "tools/truth_perception/line_of_sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rover::truth {
namespace {

constexpr double kStartM = 0.1;  // horizontal distance from the camera

// Horizontal sector that contains the view.
struct Sector {
  double from_rad = -std::numbers::pi;
  double to_rad = std::numbers::pi;
  double reach_m = 0.0;
};

// The image corners are the extremes of azimuth and distance, unless a corner looks backwards over the nadir.
Sector sector_of(const View& view) {
  const StereoCamera& camera = view.camera;
  const Eigen::Vector3d axis = view.T_map_cam.linear().col(2);
  const double heading_rad = std::atan2(axis.y(), axis.x());
  Sector sector{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0.0};
  bool forward = true;
  for (int corner = 0; corner < 4; ++corner) {
    const double u = corner & 1 ? camera.width - 1.0 : 0.0, v = corner & 2 ? camera.height - 1.0 : 0.0;
    const Eigen::Vector3d ray = view.T_map_cam.linear() * Eigen::Vector3d((u - camera.cx_px) / camera.focal_px,
                                                                          (v - camera.cy_px) / camera.focal_px, 1.0);
    const double offset_rad = std::remainder(std::atan2(ray.y(), ray.x()) - heading_rad, 2.0 * std::numbers::pi);
    forward = forward && ray.x() * axis.x() + ray.y() * axis.y() > 0.0;
    sector.from_rad = std::min(sector.from_rad, heading_rad + offset_rad);
    sector.to_rad = std::max(sector.to_rad, heading_rad + offset_rad);
    sector.reach_m = std::max(sector.reach_m, view.max_depth_m * std::hypot(ray.x(), ray.y()));
  }
  sector.reach_m = std::min(sector.reach_m, view.reach_m);
  if (!forward) sector.from_rad = -std::numbers::pi, sector.to_rad = std::numbers::pi;
  return sector;
}

}  // namespace

bool in_both_images(const View& view, const Eigen::Vector3d& p_cam) {
  if (p_cam.z() < view.min_depth_m || p_cam.z() > view.max_depth_m) return false;
  const StereoCamera& camera = view.camera;
  const double u = camera.cx_px + camera.focal_px * p_cam.x() / p_cam.z();
  const double v = camera.cy_px + camera.focal_px * p_cam.y() / p_cam.z();
  const double disparity_px = camera.focal_px * camera.baseline_m / p_cam.z();
  return u >= disparity_px && u <= camera.width - 1.0 && v >= 0.0 && v <= camera.height - 1.0;
}

// Along a ray, a point is visible if its elevation angle exceeds that of all nearer points.
void find_points_in_view(TrueSurface& surface, const View& view, std::vector<SurfacePoint>& points) {
  const Sector sector = sector_of(view);
  const Eigen::Vector3d eye = view.T_map_cam.translation();
  const Eigen::Isometry3d T_cam_map = view.T_map_cam.inverse();
  const int rays =
      1 + static_cast<int>(std::ceil((sector.to_rad - sector.from_rad) * sector.reach_m / TrueSurface::kSpacingM));
  points.clear();
  for (int ray = 0; ray <= rays; ++ray) {
    const double azimuth_rad = sector.from_rad + (sector.to_rad - sector.from_rad) * ray / rays;
    const double cosine = std::cos(azimuth_rad), sine = std::sin(azimuth_rad);
    double horizon = -std::numeric_limits<double>::infinity();
    for (double r = kStartM; r <= sector.reach_m; r += TrueSurface::kSpacingM) {
      const double x = eye.x() + r * cosine, y = eye.y() + r * sine;
      const Eigen::Vector3d p(x, y, surface.height_m(x, y));
      const double elevation = (p.z() - eye.z()) / r;
      const bool visible = elevation >= horizon;
      horizon = std::max(horizon, elevation);
      if (in_both_images(view, T_cam_map * p)) points.push_back({p, visible});
    }
  }
}

}  // namespace rover::truth
