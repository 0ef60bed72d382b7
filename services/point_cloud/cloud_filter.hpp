// PCL's filters on a cloud: one point a voxel, and none that stands alone.
#pragma once

#include <vector>

namespace rover::cloud {

// In the axes of a camera: z forward.
struct Point {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float depth_sigma_m = 0.0F;
};
using Cloud = std::vector<Point>;

struct FilterConfig {
  double voxel_m = 0.05;
  double outlier_radius_m = 0.25;
  int outlier_neighbours = 5;  // fewer within the radius: an outlier
  int max_points = 20000;      // the farthest ones are left out
};

// A voxel keeps the mean of its points, and the mean of their sigmas: the errors of neighbours are alike, for most of
// them is the calibration's, so many points of a voxel do not make it better.
Cloud filtered(const Cloud& cloud, const FilterConfig& config);

}  // namespace rover::cloud
