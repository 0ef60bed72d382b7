// Resamples a part of a height raster to the pixels of an image.
#pragma once

#include <opencv2/core.hpp>

#include "common/geo/shaded_relief.hpp"

namespace rover {

// Heights [m] as CV_32F, rows from the north; the edge is repeated beyond the raster.
cv::Mat heights_in(const HeightRaster& raster, const Box& box, int width_px, int height_px, double smoothing_m);

}  // namespace rover
