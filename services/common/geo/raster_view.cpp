#include "common/geo/raster_view.hpp"

#include <opencv2/imgproc.hpp>

namespace rover {

cv::Mat heights_in(const HeightRaster& raster, const Box& box, int width_px, int height_px, double smoothing_m) {
  cv::Mat south_first(raster.rows, raster.columns, CV_32F, const_cast<float*>(raster.z_m.data()));
  cv::Mat z;
  cv::flip(south_first, z, 0);
  const double sigma_px = smoothing_m / raster.resolution_m;
  if (sigma_px > 0.0) cv::GaussianBlur(z, z, cv::Size(), sigma_px, sigma_px, cv::BORDER_REPLICATE);
  // From image pixels to raster pixels, centres at half integers in both.
  const double step_m = box.width_m() / width_px;
  cv::Mat map_x(height_px, width_px, CV_32F);
  cv::Mat map_y(height_px, width_px, CV_32F);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) {
      const double x = box.x0_m + (u + 0.5) * step_m;
      const double y = box.y1_m - (v + 0.5) * box.height_m() / height_px;
      map_x.at<float>(v, u) = static_cast<float>(x / raster.resolution_m - 0.5);
      map_y.at<float>(v, u) = static_cast<float>(raster.rows - y / raster.resolution_m - 0.5);
    }
  cv::Mat picture;
  cv::remap(z, picture, map_x, map_y, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  const double blur_px = 0.5 * raster.resolution_m / step_m;  // hides the patches of the interpolation
  cv::GaussianBlur(picture, picture, cv::Size(), blur_px, blur_px, cv::BORDER_REPLICATE);
  return picture;
}

}  // namespace rover
