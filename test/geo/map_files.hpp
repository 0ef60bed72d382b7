// Writes test maps with GDAL from a height function.
#pragma once

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rover::testing_support {

const std::string kGale = std::string(ROVER_SOURCE_DIR) + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";
constexpr double kMarsRadiusM = 3396190.0;
const char* const kMars =
    "GEOGCS[\"Mars\",DATUM[\"D_Mars\",SPHEROID[\"Mars\",3396190,0]],PRIMEM[\"Reference meridian\",0],"
    "UNIT[\"degree\",0.0174532925199433]]";

// On Mars, in metres, with true scale at the parallel.
inline std::string mars_plane(int true_at_deg = 0, const char* unit = "UNIT[\"metre\",1]") {
  return std::string("PROJCS[\"plane\",") + kMars +
         ",PROJECTION[\"Equirectangular\"],PARAMETER[\"standard_parallel_1\"," + std::to_string(true_at_deg) +
         "],PARAMETER[\"central_meridian\",0]," + unit + "]";
}

struct MapFile {
  // All zero: none.
  std::array<double, 6> transform{1000.0, 2.0, 0.0, 5000.0, 0.0, -2.0};
  std::string reference = mars_plane();  // any format that OGR accepts
  int width = 60;
  int height = 50;
  GDALDataType type = GDT_Float32;
  int bands = 1;
  double scale = 1.0, offset = 0.0;
  std::string unit;
  std::optional<double> no_data;
  bool pixel_is_point = false;
  std::function<void(GDALDataset&)> change;  // further changes before it is filled
};

// value(column, line): stored value at the pixel centre, line 0 first.
template <class F>
void write(const std::string& file, const MapFile& map, F&& value) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.c_str(), map.width, map.height, map.bands, map.type, nullptr));
  ASSERT_NE(dataset, nullptr) << file;
  std::array<double, 6> transform = map.transform;
  if (!map.reference.empty()) {
    OGRSpatialReference reference;
    ASSERT_EQ(reference.SetFromUserInput(map.reference.c_str()), OGRERR_NONE) << map.reference;
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    dataset->SetSpatialRef(&reference);
  }
  if (transform != std::array<double, 6>{}) dataset->SetGeoTransform(transform.data());
  if (map.pixel_is_point) dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (map.scale != 1.0) band.SetScale(map.scale);
  if (map.offset != 0.0) band.SetOffset(map.offset);
  if (!map.unit.empty()) band.SetUnitType(map.unit.c_str());
  if (map.no_data) band.SetNoDataValue(*map.no_data);
  std::vector<double> z;
  for (int line = 0; line < map.height; ++line)
    for (int column = 0; column < map.width; ++column) z.push_back(value(column, line));
  for (int i = 1; i <= map.bands; ++i)
    ASSERT_EQ(dataset->GetRasterBand(i)->RasterIO(GF_Write, 0, 0, map.width, map.height, z.data(), map.width,
                                                  map.height, GDT_Float64, 0, 0, nullptr),
              CE_None);
  if (map.change) map.change(*dataset);
}

}  // namespace rover::testing_support
