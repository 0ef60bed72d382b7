// Orbital maps of other projections, with voids, damaged, of no place; longitude and latitude there and back.
#include "orbital_planner/map_file.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "common/core/frames.hpp"
#include "map_fixture.hpp"
#include "rover_simulator/world/dtm_reader.hpp"
#include "rover_simulator/world/geotiff_writer.hpp"
#include "test/common/temp_folder.hpp"

namespace rover::orbital {
namespace {

namespace fs = std::filesystem;
const std::string kGaleMap = std::string(ROVER_SOURCE_DIR) + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";
constexpr double kMarsRadiusM = 3396190.0;
const char* const kMars =
    "GEOGCS[\"Mars\",DATUM[\"D_Mars\",SPHEROID[\"Mars\",3396190,0]],PRIMEM[\"Reference meridian\",0],"
    "UNIT[\"degree\",0.0174532925199433]]";

// A GeoTIFF with rows from the north, as GDAL has them.
struct Sample {
  std::array<double, 6> transform{};
  std::string wkt;
  int width = 60;
  int height = 50;
  double scale = 1.0;
  double offset = 0.0;
};

template <class F>
void write(const std::string& file, const Sample& sample, F&& value) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.c_str(), sample.width, sample.height, 1, GDT_Float32, nullptr));
  std::array<double, 6> transform = sample.transform;
  dataset->SetGeoTransform(transform.data());
  dataset->SetProjection(sample.wkt.c_str());
  std::vector<float> z;
  for (int row = 0; row < sample.height; ++row)
    for (int column = 0; column < sample.width; ++column) z.push_back(static_cast<float>(value(column, row)));
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (sample.scale != 1.0 || sample.offset != 0.0) {
    band.SetScale(sample.scale);
    band.SetOffset(sample.offset);
  }
  band.SetNoDataValue(-9999.0);
  ASSERT_EQ(band.RasterIO(GF_Write, 0, 0, sample.width, sample.height, z.data(), sample.width, sample.height,
                          GDT_Float32, 0, 0, nullptr),
            CE_None);
}

double metres_per_degree() {
  return to_rad(1.0) * kMarsRadiusM;
}

class MapFile : public testing::Test {
 protected:
  testing_support::TempFolder folder_;

  OrbitalMap read(const std::string& name) const { return read_map(folder_.file(name), folder_.file("copy.tif")); }

  // One line that starts with the file's name.
  std::string complaint(const std::string& file) const {
    try {
      read_map(file, folder_.file("copy.tif"));
    } catch (const DtmError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(file + ": ", 0), 0u) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return text;
    }
    ADD_FAILURE() << file << " was read";
    return "";
  }
};

TEST_F(MapFile, AMapInMetresIsReadAsItIs) {
  const OrbitalMap map = read_map(kGaleMap, folder_.file("copy.tif"));
  EXPECT_FALSE(map.reprojected);
  EXPECT_FALSE(fs::exists(folder_.file("copy.tif")));
  EXPECT_EQ(map.raster.z_m, read_elevation(kGaleMap).z_m);
}

TEST_F(MapFile, VoidsAreNoData) {
  ElevationRaster raster = read_elevation(kGaleMap);
  raster.at(100, 120) = kVoid;
  raster.at(7, 8) = std::numeric_limits<float>::infinity();
  write_geotiff(folder_.file("void.tif"), raster);
  const OrbitalMap map = read("void.tif");
  EXPECT_TRUE(std::isnan(map.raster.at(100, 120)));
  EXPECT_TRUE(std::isnan(map.raster.at(7, 8)));
  EXPECT_EQ(map.raster.at(101, 120), raster.at(101, 120));
}

// 0.0002 degrees are 11.9 m northwards, at 60 degrees of latitude half of it eastwards.
TEST_F(MapFile, AMapInDegreesIsReprojectedToSquareMetres) {
  Sample sample;
  sample.wkt = kMars;
  sample.transform = {137.0, 2e-4, 0.0, 60.0, 0.0, -2e-4};
  const double slope = std::tan(to_rad(6.0));
  write(folder_.file("degrees.tif"), sample, [&](int, int row) { return -slope * 2e-4 * row * metres_per_degree(); });
  const OrbitalMap map = read("degrees.tif");
  EXPECT_TRUE(map.reprojected);
  EXPECT_TRUE(fs::exists(folder_.file("copy.tif")));
  EXPECT_NEAR(map.raster.width_m(), 60 * 2e-4 * metres_per_degree() * 0.5, 3 * map.raster.resolution_m);
  EXPECT_NEAR(map.raster.height_m(), 50 * 2e-4 * metres_per_degree(), 3 * map.raster.resolution_m);
  const int x = map.raster.width / 2, y = map.raster.height / 2;
  const double rise = map.raster.at(x, y + 5) - map.raster.at(x, y - 5);
  EXPECT_NEAR(rise / (10 * map.raster.resolution_m), slope, 0.03 * slope);
}

TEST_F(MapFile, TurnedAndOblongPixelsAreReprojected) {
  const std::string wkt = read_elevation(kGaleMap).projection_wkt;
  Sample turned;
  turned.wkt = wkt;
  turned.transform = {8146000.0, 0.8, 0.6, -270000.0, 0.6, -0.8};
  write(folder_.file("turned.tif"), turned, [](int, int) { return 3.0; });
  EXPECT_TRUE(read("turned.tif").reprojected);
  Sample oblong;
  oblong.wkt = wkt;
  oblong.transform = {8146000.0, 2.0, 0.0, -270000.0, 0.0, -1.0};
  write(folder_.file("oblong.tif"), oblong, [](int, int) { return 3.0; });
  const OrbitalMap map = read("oblong.tif");
  EXPECT_NEAR(map.raster.width_m(), 120.0, 6.0);
  EXPECT_NEAR(map.raster.height_m(), 50.0, 6.0);
}

TEST_F(MapFile, AProjectionThatIsNotTrueToScaleThereIsReprojected) {
  // Equidistant cylindrical about the equator: at 40 degrees a metre eastwards is 0.77 m on the ground.
  Sample sample;
  sample.wkt = std::string("PROJCS[\"eqc\",") + kMars +
               ",PROJECTION[\"Equirectangular\"],PARAMETER[\"standard_parallel_1\",0],"
               "PARAMETER[\"central_meridian\",0],UNIT[\"metre\",1]]";
  sample.transform = {100000.0, 1.0, 0.0, 40.0 * metres_per_degree(), 0.0, -1.0};
  write(folder_.file("eqc.tif"), sample, [](int, int) { return 3.0; });
  const OrbitalMap map = read("eqc.tif");
  EXPECT_TRUE(map.reprojected);
  EXPECT_NEAR(map.raster.width_m(), 60 * std::cos(to_rad(40.0)), 2.0);
  EXPECT_NEAR(map.raster.height_m(), 50.0, 2.0);
  sample.transform[3] = 2.0 * metres_per_degree();
  write(folder_.file("equator.tif"), sample, [](int, int) { return 3.0; });
  EXPECT_FALSE(read("equator.tif").reprojected);
}

TEST_F(MapFile, ScaledHeightsAreMadeMetres) {
  Sample sample;
  sample.wkt = read_elevation(kGaleMap).projection_wkt;
  sample.transform = {8146000.0, 1.0, 0.0, -270000.0, 0.0, -1.0};
  sample.scale = 0.5;
  sample.offset = -100.0;
  write(folder_.file("scaled.tif"), sample,
        [](int column, int row) { return column == 30 && row == 25 ? -9999.0 : 40.0; });
  const OrbitalMap map = read("scaled.tif");
  EXPECT_TRUE(map.reprojected);
  EXPECT_NEAR(map.raster.at(10, 10), -80.0, 1e-4);
  bool has_void = false;
  for (float z : map.raster.z_m) {
    has_void = has_void || std::isnan(z);
    EXPECT_TRUE(std::isnan(z) || std::abs(z + 80.0F) < 1e-3F) << z;
  }
  EXPECT_TRUE(has_void);
}

TEST_F(MapFile, BadFilesAreNamed) {
  EXPECT_NE(complaint(folder_.file("none.tif")).find("not found"), std::string::npos);
  std::ofstream(folder_.file("text.tif")) << "this is no map\n";
  EXPECT_NE(complaint(folder_.file("text.tif")).find("not a readable map"), std::string::npos);
  std::ofstream(folder_.file("plain.pgm"), std::ios::binary) << "P5 20 20 255\n" << std::string(400, 'a');
  EXPECT_NE(complaint(folder_.file("plain.pgm")).find("no georeference"), std::string::npos);
}

TEST_F(MapFile, CutFilesAreNoticed) {
  Sample sample;
  sample.wkt = kMars;
  sample.transform = {137.0, 1e-5, 0.0, -4.0, 0.0, -1e-5};
  sample.width = sample.height = 400;
  write(folder_.file("degrees.tif"), sample, [](int column, int row) { return 0.1 * column + 0.2 * row; });
  for (const std::string& whole : {kGaleMap, folder_.file("degrees.tif")})
    for (double share : {0.01, 0.3, 0.9}) {
      fs::copy_file(whole, folder_.file("cut.tif"), fs::copy_options::overwrite_existing);
      fs::permissions(folder_.file("cut.tif"), fs::perms::owner_all);
      fs::resize_file(folder_.file("cut.tif"),
                      static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(whole))));
      complaint(folder_.file("cut.tif"));
    }
}

TEST_F(MapFile, AMapWithoutHeightsIsNoticed) {
  ElevationRaster raster = read_elevation(kGaleMap);
  std::fill(raster.z_m.begin(), raster.z_m.end(), kVoid);
  write_geotiff(folder_.file("empty.tif"), raster);
  EXPECT_NE(complaint(folder_.file("empty.tif")).find("no heights"), std::string::npos);
}

TEST_F(MapFile, AMapTooLargeToPlanOnIsNoticedBeforeItIsRead) {
  std::ofstream(folder_.file("huge.vrt")) << "<VRTDataset rasterXSize=\"60000\" rasterYSize=\"50000\"><SRS>" << kMars
                                          << "</SRS><GeoTransform>137,1e-5,0,-4,0,-1e-5</GeoTransform>"
                                          << "<VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>";
  EXPECT_NE(complaint(folder_.file("huge.vrt")).find("too large"), std::string::npos);
}

TEST_F(MapFile, LongitudeAndLatitudeLeadThereAndBack) {
  Sample sample;
  sample.wkt = kMars;
  sample.transform = {-137.0, 2e-4, 0.0, 60.0, 0.0, -2e-4};
  write(folder_.file("degrees.tif"), sample, [](int, int) { return 1.0; });
  for (const ElevationRaster& raster : {read_elevation(kGaleMap), read("degrees.tif").raster}) {
    const Geography geography(raster);
    for (double u : {0.0, 0.3, 1.0})
      for (double v : {0.0, 0.6, 1.0}) {
        const Eigen::Vector2d p(u * raster.width_m(), v * raster.height_m());
        EXPECT_LT((geography.to_map(geography.to_lon_lat(p)) - p).norm(), 1e-4);
      }
  }
}

TEST_F(MapFile, LongitudeAndLatitudeAreThoseOfTheMap) {
  // Gale crater lies at 137.4 deg east, 4.6 deg south.
  const ElevationRaster gale = read_elevation(kGaleMap);
  const Geography geography(gale);
  const Eigen::Vector2d corner = geography.to_lon_lat({0.0, 0.0});
  EXPECT_NEAR(corner.x(), 137.4, 0.2);
  EXPECT_NEAR(corner.y(), -4.6, 0.2);
  // Northwards by a hundred metres; the projection's sphere may differ from Mars' radius by its flattening.
  const Eigen::Vector2d north = geography.to_lon_lat({0.0, 100.0});
  EXPECT_NEAR((north.y() - corner.y()) * metres_per_degree(), 100.0, 1.5);
  EXPECT_NEAR(north.x(), corner.x(), 1e-9);
}

TEST_F(MapFile, WhatIsNoPlaceOnThePlanetIsNone) {
  const Geography geography(read_elevation(kGaleMap));
  EXPECT_FALSE(geography.to_map({kNaN, 4.0}).allFinite());
  EXPECT_FALSE(geography.to_map({10.0, 400.0}).allFinite());
}

}  // namespace
}  // namespace rover::orbital
