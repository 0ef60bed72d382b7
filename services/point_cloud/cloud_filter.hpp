// PCL filters: voxel downsampling and radius outlier removal.
#pragma once

#include <limits>
#include <vector>

namespace rover::cloud {

// In camera axes: z forward.
struct Point {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float depth_sigma_m = 0.0F;
  float brightness = std::numeric_limits<float>::quiet_NaN();  // grey value per second of exposure; NaN: no picture
};
using Cloud = std::vector<Point>;

struct FilterConfig {
  double voxel_m = 0.05;
  double outlier_radius_m = 0.25;
  int outlier_neighbours = 5;  // fewer within the radius: outlier
  int max_points = 20000;      // the farthest are dropped
};

// A voxel gets the mean of its points, of their sigmas and of their brightness. Errors of neighbours are correlated
// (mostly calibration), so averaging does not reduce sigma.
Cloud filter_cloud(const Cloud& cloud, const FilterConfig& config);

}  // namespace rover::cloud
