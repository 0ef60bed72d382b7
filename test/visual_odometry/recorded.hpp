// Recorded stereo sequences for the tests.
#pragma once

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "common/core/image.hpp"

namespace rover::vo {

inline GrayImage read_gray(const std::string& file) {
  const cv::Mat mat = cv::imread(file, cv::IMREAD_GRAYSCALE);
  GrayImage image(mat.cols, mat.rows);
  for (int y = 0; y < mat.rows; ++y) std::copy_n(mat.ptr<std::uint8_t>(y), mat.cols, &image.data[size_t(y) * mat.cols]);
  return image;
}

}  // namespace rover::vo
