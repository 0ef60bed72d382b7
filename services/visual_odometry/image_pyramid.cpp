#include "visual_odometry/image_pyramid.hpp"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace rover::vo {
namespace {

constexpr int kSmallestSide = 24;

cv::Mat to_mat(const GrayImage& image) {
  cv::Mat mat(image.height, image.width, CV_8UC1);
  std::memcpy(mat.data, image.data.data(), image.data.size());
  return mat;
}

}  // namespace

ImagePyramid build_pyramid(const GrayImage& image, int levels) {
  ROVER_CHECK(image.width > 0 && image.height > 0 && levels >= 1, image.width, image.height, levels);
  ImagePyramid pyramid;
  pyramid.levels.push_back(to_mat(image));
  while (pyramid.count() < levels) {
    const cv::Mat& above = pyramid.levels.back();
    if (std::min(above.cols, above.rows) / 2 < kSmallestSide) break;
    cv::Mat half;
    cv::pyrDown(above, half);
    pyramid.levels.push_back(half);
  }
  return pyramid;
}

}  // namespace rover::vo
