// Image pyramid: level 0 is the image, each further level has half the size.
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

// Copies the image. No level has a side below 24 px.
ImagePyramid build_pyramid(const GrayImage& image, int levels);

}  // namespace rover::vo
