#include "common/geo/shaded_relief.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/core/frames.hpp"
#include "common/geo/jpeg.hpp"
#include "common/geo/raster_view.hpp"

namespace rover {
namespace {

// Sun from the north-west, as maps have it.
constexpr double kSunAzimuth = 135.0;  // of the direction to the sun, counter-clockwise from east
constexpr double kSunElevation = 40.0;
const cv::Vec3d kShadow(92, 118, 146);  // BGR
const cv::Vec3d kLight(222, 236, 247);
const cv::Vec3d kContour(60, 84, 112);

// z: rows from the north, one pixel each step_m.
cv::Mat shade(const cv::Mat& z, double step_m, const ReliefStyle& style) {
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(z, dx, CV_32F, 1, 0, 3, 1.0 / (8.0 * step_m));
  cv::Sobel(z, dy, CV_32F, 0, 1, 3, -1.0 / (8.0 * step_m));
  const double elevation = to_rad(kSunElevation);
  const double azimuth = to_rad(kSunAzimuth);
  const double sx = std::cos(elevation) * std::cos(azimuth);
  const double sy = std::cos(elevation) * std::sin(azimuth);
  const double sz = std::sin(elevation);
  cv::Mat picture(z.size(), CV_8UC3);
  for (int v = 0; v < z.rows; ++v)
    for (int u = 0; u < z.cols; ++u) {
      const double gx = style.exaggeration * dx.at<float>(v, u);
      const double gy = style.exaggeration * dy.at<float>(v, u);
      const double light = (sz - gx * sx - gy * sy) / std::sqrt(1.0 + gx * gx + gy * gy);
      cv::Vec3d colour = kShadow + (kLight - kShadow) * std::clamp(0.5 + 0.75 * (light - sz), 0.0, 1.0);
      if (style.contour_interval_m > 0.0) {
        // Distance in pixels to the nearest contour line, to first order.
        const double level = z.at<float>(v, u) / style.contour_interval_m;
        const double slope = std::hypot(dx.at<float>(v, u), dy.at<float>(v, u)) * step_m / style.contour_interval_m;
        const double pixels = std::abs(level - std::round(level)) / std::max(slope, 1e-6);
        colour += (kContour - colour) * (0.35 * std::clamp(1.2 - pixels, 0.0, 1.0));
      }
      picture.at<cv::Vec3b>(v, u) = cv::Vec3b(cv::saturate_cast<uchar>(colour[0]), cv::saturate_cast<uchar>(colour[1]),
                                              cv::saturate_cast<uchar>(colour[2]));
    }
  return picture;
}

}  // namespace

std::vector<std::uint8_t> relief_jpeg(const HeightRaster& raster, const Box& box, int width_px, int height_px,
                                      const ReliefStyle& style) {
  return jpeg_of(
      shade(heights_in(raster, box, width_px, height_px, style.smoothing_m), box.width_m() / width_px, style),
      kMapQuality);
}

std::vector<std::uint8_t> relief_jpeg(const std::function<double(double, double)>& height_m, const Box& box,
                                      int width_px, int height_px, const ReliefStyle& style) {
  cv::Mat z(height_px, width_px, CV_32F);
  const double step_m = box.width_m() / width_px;
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u)
      z.at<float>(v, u) = static_cast<float>(
          height_m(box.x0_m + (u + 0.5) * step_m, box.y1_m - (v + 0.5) * box.height_m() / height_px));
  return jpeg_of(shade(z, step_m, style), kMapQuality);
}

}  // namespace rover
