#include "common/geo/jpeg.hpp"

#include <opencv2/imgcodecs.hpp>

namespace rover {

std::vector<std::uint8_t> jpeg_of(const cv::Mat& picture, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

}  // namespace rover
