// The height band of a file, converted to metres, or the brightness of a picture.
#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "common/geo/elevation_raster.hpp"

namespace rover {

class HeightBand {
 public:
  // Throws DtmError for no band; of heights also for several bands, or a picture.
  HeightBand(GDALDataset& dataset, const std::string& file, RasterKind kind = RasterKind::kHeights);

  // Whether the stored values are metres.
  bool is_metres() const { return scale_ == 1.0 && offset_ == 0.0; }
  PixelBox all() const { return {0, 0, bands_.front()->GetXSize(), bands_.front()->GetYSize()}; }
  // Row 0 of the raster is the last line; NaN for masked and invalid values. Throws DtmError if unreadable.
  ElevationRaster read(const PixelBox& box) const;

 private:
  float height_of(double value, bool masked) const;

  std::string file_;
  std::vector<GDALRasterBand*> bands_;  // of one type; of heights, one
  GDALRasterBand* alpha_;               // null: none. GDAL uses it as a mask only if it is an integer band
  double scale_ = 1.0;                  // metres
  double offset_ = 0.0;
  double lowest_ = 0.0;  // limits of the data type, which count as void
  double highest_ = 0.0;
};

}  // namespace rover
