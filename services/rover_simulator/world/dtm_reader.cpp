#include "rover_simulator/world/dtm_reader.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "rover_simulator/world/gdal_session.hpp"

namespace rover {
namespace {

std::array<double, 6> georeference(GDALDataset& dataset, const std::string& file) {
  std::array<double, 6> t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None || std::string(dataset.GetProjectionRef()).empty())
    throw DtmError(file + ": elevation model has no georeference");
  if (t[2] != 0.0 || t[4] != 0.0 || t[1] <= 0.0 || std::abs(t[1] + t[5]) > 1e-6 * t[1])
    throw DtmError(file + ": elevation model is not north-up with square pixels");
  return t;
}

void treat_voids(GDALRasterBand& band, std::vector<float>& heights, Voids voids, const std::string& file) {
  int has_void = 0;
  const double void_value = band.GetNoDataValue(&has_void);
  for (float& z : heights) {
    if (std::isfinite(z) && !(has_void && static_cast<double>(z) == void_value)) continue;
    if (voids == Voids::kRefuse) throw DtmError(file + ": elevation model has voids");
    z = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

ElevationRaster read_elevation(const std::string& file, Voids voids) {
  if (!std::filesystem::is_regular_file(file)) throw DtmError(file + ": elevation model not found");
  const GdalSession gdal;
  const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset || dataset->GetRasterCount() < 1)
    throw DtmError(file + ": not a readable elevation model" + gdal.last_error());
  const std::array<double, 6> t = georeference(*dataset, file);
  ElevationRaster raster;
  raster.width = dataset->GetRasterXSize();
  raster.height = dataset->GetRasterYSize();
  raster.resolution_m = t[1];
  raster.west_m = t[0];
  raster.south_m = t[3] + t[5] * raster.height;
  raster.projection_wkt = dataset->GetProjectionRef();
  raster.z_m.resize(static_cast<size_t>(raster.width) * raster.height);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  // Rows from the south: start at the last line and step backwards.
  float* last_row = raster.z_m.data() + static_cast<size_t>(raster.height - 1) * raster.width;
  const CPLErr error =
      band.RasterIO(GF_Read, 0, 0, raster.width, raster.height, last_row, raster.width, raster.height, GDT_Float32,
                    sizeof(float), -static_cast<GSpacing>(sizeof(float)) * raster.width, nullptr);
  if (error != CE_None) throw DtmError(file + ": elevation model is cut short or damaged" + gdal.last_error());
  treat_voids(band, raster.z_m, voids, file);
  return raster;
}

}  // namespace rover
