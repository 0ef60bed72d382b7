#include "common/geo/open_map.hpp"

#include <filesystem>

#include "common/geo/elevation_map.hpp"
#include "common/geo/gdal_session.hpp"

namespace rover {
namespace {

constexpr std::int64_t kCacheBytes = 32'000'000;  // GDAL keeps blocks of up to 5 % of the machine's memory by default

std::unique_ptr<GDALDataset> opened(const std::string& file) {
  const GdalSession gdal;
  GDALSetCacheMax64(kCacheBytes);
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw DtmError(file + ": is a folder; a map is expected");
  if (!std::filesystem::is_regular_file(file, error)) throw DtmError(file + ": not found");
  // GDAL looks for side files (.prj, .tfw) beside the file itself, not beside a link to it.
  const std::string path = std::filesystem::canonical(file, error).string();
  std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset) throw DtmError(file + ": not a readable map" + gdal.last_error());
  if (dataset->GetRasterCount() < 1)
    throw DtmError(file + ": contains no map, or several; gdalinfo lists them, gdal_translate extracts one");
  return dataset;
}

}  // namespace

OpenMap::OpenMap(const std::string& name, RasterKind kind)
    : file(name), dataset(opened(name)), placement(*dataset, name), band(*dataset, name, kind) {}

}  // namespace rover
