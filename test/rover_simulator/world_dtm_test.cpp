#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

#include "rover_simulator/world/dtm_reader.hpp"
#include "rover_simulator/world/geotiff_writer.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;
const std::string kGale = std::string(ROVER_SOURCE_DIR) + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";

class DtmFile : public testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() / ("rover_dtm_" + std::to_string(::getpid()));
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }
  std::string path(const std::string& name) const { return (dir_ / name).string(); }

  // What the reader says of the file: one line that starts with its name.
  std::string complaint(const std::string& file) const {
    try {
      read_elevation(file);
    } catch (const DtmError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(file + ": ", 0), 0u) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return text;
    }
    ADD_FAILURE() << file << " was read";
    return "";
  }

  fs::path dir_;
};

TEST_F(DtmFile, ReadsGaleFromTheSouthWest) {
  const ElevationRaster raster = read_elevation(kGale);
  EXPECT_EQ(raster.width, 348);
  EXPECT_EQ(raster.height, 337);
  EXPECT_DOUBLE_EQ(raster.resolution_m, 1.0);
  EXPECT_NE(raster.projection_wkt.find("Mars"), std::string::npos);
  const auto [low, high] = std::minmax_element(raster.z_m.begin(), raster.z_m.end());
  EXPECT_GT(*low, -4700.0f);
  EXPECT_LT(*high, -4300.0f);
  EXPECT_GT(*high - *low, 10.0f);
}

TEST_F(DtmFile, WritesWhatItReads) {
  const ElevationRaster raster = read_elevation(kGale);
  write_geotiff(path("copy.tif"), raster);
  const ElevationRaster copy = read_elevation(path("copy.tif"));
  EXPECT_EQ(copy.width, raster.width);
  EXPECT_EQ(copy.z_m, raster.z_m);
  EXPECT_DOUBLE_EQ(copy.west_m, raster.west_m);
  EXPECT_DOUBLE_EQ(copy.south_m, raster.south_m);
  EXPECT_DOUBLE_EQ(copy.resolution_m, raster.resolution_m);
  EXPECT_NE(copy.projection_wkt.find("Mars"), std::string::npos);
}

TEST_F(DtmFile, MissingFileIsNamed) {
  EXPECT_NE(complaint(path("none.tif")).find("not found"), std::string::npos);
}

TEST_F(DtmFile, CutFileIsNoticed) {
  for (std::uintmax_t bytes : {100u, 20000u, 200000u}) {
    const std::string file = path("cut" + std::to_string(bytes) + ".tif");
    fs::copy_file(kGale, file);
    fs::permissions(file, fs::perms::owner_all);
    fs::resize_file(file, bytes);
    complaint(file);
  }
}

TEST_F(DtmFile, ForeignFileIsNoticed) {
  std::ofstream(path("text.tif")) << "this is no elevation model\n";
  complaint(path("text.tif"));
}

TEST_F(DtmFile, NoGeoreferenceIsNoticed) {
  // A plain image without tags for place and projection.
  std::ofstream image(path("plain.pgm"), std::ios::binary);
  image << "P5 20 20 255\n" << std::string(400, 'a');
  image.close();
  EXPECT_NE(complaint(path("plain.pgm")).find("no georeference"), std::string::npos);
  ElevationRaster raster = read_elevation(kGale);
  raster.projection_wkt.clear();
  write_geotiff(path("no_projection.tif"), raster);
  EXPECT_NE(complaint(path("no_projection.tif")).find("no georeference"), std::string::npos);
}

TEST_F(DtmFile, VoidsAreNoticed) {
  ElevationRaster raster = read_elevation(kGale);
  raster.at(100, 100) = std::numeric_limits<float>::quiet_NaN();
  write_geotiff(path("void.tif"), raster);
  EXPECT_NE(complaint(path("void.tif")).find("voids"), std::string::npos);
}

TEST_F(DtmFile, UnwritablePlaceIsNamed) {
  EXPECT_THROW(write_geotiff(path("no_such_folder/map.tif"), read_elevation(kGale)), DtmError);
}

}  // namespace
}  // namespace rover
