// Image pyramid: level 0 is the image itself, each further level half of the one before.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/core/image.hpp"

namespace rover::vo {

struct ImagePyramid {
  std::vector<cv::Mat> levels;  // CV_8UC1

  const cv::Mat& base() const { return levels.front(); }
  int count() const { return static_cast<int>(levels.size()); }
};

// Copies the image; stops before a level whose shorter side would be below 24 px.
ImagePyramid build_pyramid(const GrayImage& image, int levels);

}  // namespace rover::vo
