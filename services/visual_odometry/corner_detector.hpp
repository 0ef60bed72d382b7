// Shi-Tomasi corners (CVPR 1994), spread over the image by buckets.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace rover::vo {

struct CornerConfig {
  int buckets_x = 12;
  int buckets_y = 9;
  int per_bucket = 3;
  int border_px = 10;            // minimum distance of corners from the image border
  int min_distance_px = 8;       // between two corners
  double min_eigenvalue = 4e-5;  // of the structure tensor over 5 x 5 px, grey values in [0, 1]: about twice that of
                                 // noise of one grey value
};

// In a fixed order: buckets row by row, strongest first.
std::vector<Eigen::Vector2f> detect_corners(const cv::Mat& image, const CornerConfig& config);

}  // namespace rover::vo
