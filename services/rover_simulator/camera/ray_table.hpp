// Precomputed undistorted viewing ray of each pixel (OpenCV's distortion models).
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "common/core/camera_rig.hpp"

namespace rover {

// Pixel of a direction in camera axes (z > 0).
Eigen::Vector2d project(const PinholeCamera& camera, const Eigen::Vector3d& direction);
// Viewing direction (x, y, 1) of the pixel in camera axes.
Eigen::Vector3d ray_of_pixel(const PinholeCamera& camera, const Eigen::Vector2d& pixel);
// False beyond 80 deg from the axis, and where the distortion model is not invertible.
bool has_ray(const PinholeCamera& camera, const Eigen::Vector2d& pixel);

struct RayTable {
  int width = 0;
  int height = 0;
  int stride = 0;                // width + 1: the table has one extra column and row
  float pixel_angle_rad = 0.0F;  // at the image centre
  std::vector<float> x;          // ray = (x, y, 1) in camera axes; rows from the top
  std::vector<float> y;
};

RayTable make_ray_table(const PinholeCamera& camera, int width, int height);

}  // namespace rover
