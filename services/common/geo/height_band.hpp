// The height band of a file, converted to metres.
#pragma once

#include <gdal_priv.h>

#include <string>

#include "common/geo/elevation_raster.hpp"

namespace rover {

class HeightBand {
 public:
  // Throws DtmError for no band, several bands, or a picture.
  HeightBand(GDALDataset& dataset, const std::string& file);

  // Whether the stored values are metres.
  bool is_metres() const { return scale_ == 1.0 && offset_ == 0.0; }
  PixelBox all() const { return {0, 0, band_.GetXSize(), band_.GetYSize()}; }
  // Row 0 of the raster is the last line; NaN for masked and invalid values. Throws DtmError if unreadable.
  ElevationRaster read(const PixelBox& box) const;

 private:
  float height_of(double value, bool masked) const;

  std::string file_;
  GDALRasterBand& band_;
  GDALRasterBand* alpha_;  // null: none. GDAL uses it as a mask only if it is an integer band
  double scale_ = 1.0;     // metres
  double offset_ = 0.0;
  double lowest_ = 0.0;  // limits of the data type, which count as void
  double highest_ = 0.0;
};

}  // namespace rover
