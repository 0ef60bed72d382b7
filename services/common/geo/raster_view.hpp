// A piece of a height raster at the resolution of a picture.
#pragma once

#include <opencv2/core.hpp>

#include "common/geo/shaded_relief.hpp"

namespace rover {

// Heights [m] as CV_32F, rows from the north; beyond the raster its edge goes on.
cv::Mat heights_in(const HeightRaster& raster, const Box& box, int width_px, int height_px, double smoothing_m);

}  // namespace rover
