#include "common/geo/geotiff_writer.hpp"

#include <limits>
#include <memory>

#include "common/geo/elevation_map.hpp"
#include "common/geo/gdal_session.hpp"

namespace rover {

void write_geotiff(const std::string& file, const ElevationRaster& raster) {
  const GdalSession gdal;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) throw DtmError(file + ": GDAL has no GeoTIFF driver");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.c_str(), raster.width, raster.height, 1, GDT_Float32, nullptr));
  if (!dataset) throw DtmError(file + ": cannot write the map" + gdal.last_error());
  double transform[6] = {raster.west_m, raster.resolution_m, 0.0, raster.south_m + raster.height_m(),
                         0.0,           -raster.resolution_m};
  dataset->SetGeoTransform(transform);
  dataset->SetProjection(raster.projection_wkt.c_str());
  dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  // GDAL's lines run from the north. It does not write through the pointer.
  auto* last_row = const_cast<float*>(raster.z_m.data()) + static_cast<size_t>(raster.height - 1) * raster.width;
  const CPLErr error = dataset->GetRasterBand(1)->RasterIO(
      GF_Write, 0, 0, raster.width, raster.height, last_row, raster.width, raster.height, GDT_Float32, sizeof(float),
      -static_cast<GSpacing>(sizeof(float)) * raster.width, nullptr);
  dataset->FlushCache();
  if (error != CE_None || gdal.failed()) throw DtmError(file + ": cannot write the map" + gdal.last_error());
}

}  // namespace rover
