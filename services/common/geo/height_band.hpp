// The one band of heights of a file, and its numbers as metres.
#pragma once

#include <gdal_priv.h>

#include <string>

#include "common/geo/elevation_raster.hpp"

namespace rover {

class HeightBand {
 public:
  // Throws DtmError where there is none, or more than one, or where it is a picture.
  HeightBand(GDALDataset& dataset, const std::string& file);

  // Whether the file's numbers are the heights in metres.
  bool is_metres() const { return scale_ == 1.0 && offset_ == 0.0; }
  // Row 0 of the raster is the last line; NaN for what the file masks or no number can be. Throws DtmError where it
  // cannot be read.
  ElevationRaster read() const;

 private:
  float height_of(double value, bool masked) const;

  std::string file_;
  GDALRasterBand& band_;
  GDALRasterBand* alpha_;  // null: none. GDAL takes it for a mask only where it is of whole numbers
  double scale_ = 1.0;     // metres
  double offset_ = 0.0;
  double lowest_ = 0.0;  // of the type: a value at its limits is none
  double highest_ = 0.0;
};

}  // namespace rover
