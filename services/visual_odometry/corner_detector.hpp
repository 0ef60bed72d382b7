// Corners spread over the image: the strongest of each bucket by Shi and Tomasi's measure (CVPR 1994).
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace rover::vo {

struct CornerConfig {
  int buckets_x = 12;
  int buckets_y = 9;
  int per_bucket = 3;
  int border_px = 10;            // corners keep this distance from the image's edge
  int min_distance_px = 8;       // between two corners
  double min_eigenvalue = 4e-5;  // of the gradient's second moments over 5 x 5 px, grey values in [0, 1]: about twice
                                 // what noise of one grey value makes
};

// In a fixed order: buckets row by row, the strongest first.
std::vector<Eigen::Vector2f> detect_corners(const cv::Mat& image, const CornerConfig& config);

}  // namespace rover::vo
