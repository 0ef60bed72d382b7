// JPEG encoding for the report and the page.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace rover {

inline constexpr int kMapQuality = 88;
inline constexpr int kCameraQuality = 80;

// Quality: 0 to 100.
std::vector<std::uint8_t> jpeg_of(const cv::Mat& picture, int quality);

}  // namespace rover
