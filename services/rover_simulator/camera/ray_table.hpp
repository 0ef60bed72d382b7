// The viewing ray of each pixel, with the lens distortion taken out once (OpenCV's models).
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "common/core/camera_rig.hpp"

namespace rover {

// Pixel of a direction in camera axes (z > 0).
Eigen::Vector2d project(const PinholeCamera& camera, const Eigen::Vector3d& direction);
// Direction (x, y, 1) in camera axes that the pixel sees.
Eigen::Vector3d ray_of_pixel(const PinholeCamera& camera, const Eigen::Vector2d& pixel);
// Is there one? Not beyond 80 deg from the axis, nor where the distortion folds the picture.
bool has_ray(const PinholeCamera& camera, const Eigen::Vector2d& pixel);

struct RayTable {
  int width = 0;
  int height = 0;
  int stride = 0;                // width + 1: one column and one row beyond the image are there too
  float pixel_angle_rad = 0.0F;  // at the image centre
  std::vector<float> x;          // ray = (x, y, 1) in camera axes; rows from the top
  std::vector<float> y;
};

RayTable make_ray_table(const PinholeCamera& camera, int width, int height);

}  // namespace rover
