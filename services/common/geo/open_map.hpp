// A file opened with GDAL: its georeference and its band of heights.
#pragma once

#include <gdal_priv.h>

#include <memory>
#include <string>

#include "common/geo/height_band.hpp"
#include "common/geo/placement.hpp"

namespace rover {

struct OpenMap {
  // Reads no heights. Throws DtmError.
  explicit OpenMap(const std::string& file);

  std::string file;
  std::unique_ptr<GDALDataset> dataset;
  Placement placement;
  HeightBand band;
};

}  // namespace rover
