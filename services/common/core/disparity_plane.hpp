// A plane in the world is a plane in the disparity image: d = f B / Z with 1 / Z = -(n . r) / h for the ray
// r = ((u - cx) / f, (v - cy) / f, 1), the plane's unit normal n in camera axes and the camera's height h over it.
#pragma once

#include <Eigen/Geometry>

#include "common/core/image.hpp"

namespace rover {

struct DisparityPlane {
  double at_origin_px = 0.0;  // at pixel (0, 0)
  double per_u = 0.0;
  double per_v = 0.0;

  double at(double u, double v) const { return at_origin_px + per_u * u + per_v * v; }
};

// Plane through the point with the unit normal, both in body axes.
inline DisparityPlane disparity_plane(const StereoCamera& camera, const Eigen::Vector3d& p_body_plane,
                                      const Eigen::Vector3d& normal_body) {
  const double height_m = normal_body.dot(camera.T_body_cam.translation() - p_body_plane);
  const Eigen::Vector3d n = camera.T_body_cam.linear().transpose() * normal_body;
  const double scale = -camera.focal_px * camera.baseline_m / height_m;
  DisparityPlane plane;
  plane.per_u = scale * n.x() / camera.focal_px;
  plane.per_v = scale * n.y() / camera.focal_px;
  plane.at_origin_px = scale * n.z() - plane.per_u * camera.cx_px - plane.per_v * camera.cy_px;
  return plane;
}

}  // namespace rover
