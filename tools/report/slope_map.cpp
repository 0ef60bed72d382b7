#include "tools/report/slope_map.hpp"

#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "common/core/frames.hpp"
#include "common/geo/jpeg.hpp"
#include "common/geo/raster_view.hpp"

namespace rover::report {
namespace {

constexpr double kSmoothingM = 0.8;  // equal to that of the relief

cv::Vec3b bgr_of(const char* colour) {
  const auto rgb = static_cast<unsigned>(std::strtoul(colour + 1, nullptr, 16));
  return {static_cast<uchar>(rgb & 255U), static_cast<uchar>((rgb >> 8U) & 255U), static_cast<uchar>(rgb >> 16U)};
}

cv::Vec3b colour_of(double slope_deg) {
  size_t i = 0;
  while (i + 1 < kSlopeClasses.size() && slope_deg > kSlopeClasses[i].to_deg) ++i;
  return bgr_of(kSlopeClasses[i].colour);
}

}  // namespace

std::vector<std::uint8_t> slope_jpeg(const HeightRaster& raster, const Box& box, int width_px, int height_px) {
  const cv::Mat z = heights_in(raster, box, width_px, height_px, kSmoothingM);
  const double step_m = box.width_m() / width_px;
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(z, dx, CV_32F, 1, 0, 3, 1.0 / (8.0 * step_m));
  cv::Sobel(z, dy, CV_32F, 0, 1, 3, 1.0 / (8.0 * step_m));
  cv::Mat picture(z.size(), CV_8UC3);
  for (int v = 0; v < z.rows; ++v)
    for (int u = 0; u < z.cols; ++u)
      picture.at<cv::Vec3b>(v, u) = colour_of(to_deg(std::atan(std::hypot(dx.at<float>(v, u), dy.at<float>(v, u)))));
  return jpeg_of(picture, kMapQuality);
}

}  // namespace rover::report
