// A file opened with GDAL: its georeference and its heights or brightness.
#pragma once

#include <gdal_priv.h>

#include <exception>
#include <memory>
#include <new>
#include <string>

#include "common/geo/elevation_map.hpp"
#include "common/geo/height_band.hpp"
#include "common/geo/placement.hpp"

namespace rover {

struct OpenMap {
  // Reads no heights. Throws DtmError.
  explicit OpenMap(const std::string& file, RasterKind kind = RasterKind::kHeights);

  std::string file;
  std::unique_ptr<GDALDataset> dataset;
  Placement placement;
  HeightBand band;
};

// Exceptions of GDAL's drivers become DtmError.
template <class F>
auto naming_errors(const std::string& file, F&& f) {
  try {
    return f();
  } catch (const DtmError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw DtmError(file + ": too large for the memory; cut out a part (gdal_translate -projwin)");
  } catch (const std::exception& error) {
    throw DtmError(file + ": not a readable map (" + error.what() + ")");
  }
}

}  // namespace rover
