#include "tools/orbital_planner/layers_file.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "common/geo/elevation_map.hpp"
#include "common/geo/gdal_session.hpp"

namespace rover::orbital {
namespace {

using Band = std::pair<const char*, std::vector<float>>;

std::vector<Band> bands_of(const TerrainLayers& layers) {
  std::vector<float> slope_deg, classes;
  for (float s : layers.slope_rad) slope_deg.push_back(static_cast<float>(to_deg(s)));
  for (TerrainClass c : layers.terrain_class) classes.push_back(static_cast<float>(c));
  return {{"slope [deg]", std::move(slope_deg)},
          {"roughness [m]", layers.roughness_m},
          {"step [m]", layers.step_m},
          {"difficulty", layers.difficulty},
          {"class: 0 unknown, 1 level, 2 sloping, 3 steep, 4 rough, 5 obstacle", std::move(classes)}};
}

// GDAL rows run from the north.
CPLErr write_band(GDALRasterBand& band, const TerrainLayers& layers, Band& content) {
  band.SetDescription(content.first);
  band.SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  float* last_row = content.second.data() + static_cast<size_t>(layers.height - 1) * layers.width;
  return band.RasterIO(GF_Write, 0, 0, layers.width, layers.height, last_row, layers.width, layers.height, GDT_Float32,
                       sizeof(float), -static_cast<GSpacing>(sizeof(float)) * layers.width, nullptr);
}

}  // namespace

void write_layers(const std::string& file, const ElevationRaster& map, const TerrainLayers& layers) {
  const GdalSession gdal;
  std::vector<Band> bands = bands_of(layers);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) throw DtmError(file + ": GDAL has no GeoTIFF driver");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.c_str(), layers.width, layers.height, static_cast<int>(bands.size()), GDT_Float32, nullptr));
  if (!dataset) throw DtmError(file + ": cannot be written" + gdal.last_error());
  double transform[6] = {map.west_m, map.resolution_m, 0.0, map.south_m + map.height_m(), 0.0, -map.resolution_m};
  dataset->SetGeoTransform(transform);
  dataset->SetProjection(map.projection_wkt.c_str());
  bool written = true;
  for (size_t i = 0; i < bands.size(); ++i)
    written = write_band(*dataset->GetRasterBand(static_cast<int>(i) + 1), layers, bands[i]) == CE_None && written;
  dataset->FlushCache();
  if (!written || gdal.failed()) throw DtmError(file + ": cannot be written" + gdal.last_error());
}

}  // namespace rover::orbital
