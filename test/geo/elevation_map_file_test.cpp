// Maps read in parts, compared with the same maps read whole.
#include "common/geo/elevation_map_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "common/geo/elevation_map.hpp"
#include "map_files.hpp"
#include "test/common/temp_folder.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;
using testing_support::MapFile;
using testing_support::write;

class MapInParts : public testing::Test {
 protected:
  std::string hills(const MapFile& map) const {
    const std::string file = folder_.file("map.tif");
    write(file, map, [](int x, int y) { return 100.0 + 0.3 * x + 2.0 * std::sin(0.2 * y); });
    return file;
  }
  static std::string refusal(const std::string& file) {
    try {
      const ElevationMapFile map(file);
    } catch (const DtmError& error) {
      return error.what();
    }
    return "";
  }

  testing_support::TempFolder folder_;
};

TEST_F(MapInParts, EachPartEqualsTheWholeThere) {
  MapFile feet;
  feet.unit = "ft";
  feet.scale = 2.0;
  feet.offset = 5.0;
  for (const MapFile& map : {MapFile{}, feet}) {
    const std::string name = hills(map);
    const ElevationRaster whole = read_elevation_map(name).raster;
    const ElevationMapFile file(name);
    EXPECT_EQ(file.frame().width, whole.width);
    EXPECT_EQ(file.frame().height, whole.height);
    EXPECT_DOUBLE_EQ(file.frame().west_m, whole.west_m);
    EXPECT_DOUBLE_EQ(file.frame().south_m, whole.south_m);
    std::mt19937_64 random(5);
    for (int k = 0; k < 50; ++k) {
      const PixelBox box{static_cast<int>(random() % 90) - 15, static_cast<int>(random() % 80) - 15,
                         static_cast<int>(random() % 40), static_cast<int>(random() % 40)};
      const ElevationRaster part = file.read(box);
      const int west = std::clamp(box.column, 0, whole.width), south = std::clamp(box.row, 0, whole.height);
      EXPECT_EQ(part.width, std::max(0, std::min(box.column + box.width, whole.width) - west));
      EXPECT_EQ(part.height, std::max(0, std::min(box.row + box.height, whole.height) - south));
      EXPECT_DOUBLE_EQ(part.west_m, whole.west_m + west * whole.resolution_m);
      for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) ASSERT_EQ(part.at(x, y), whole.at(west + x, south + y));
    }
  }
}

TEST_F(MapInParts, VoidsOfAPartAreFound) {
  const std::string file = folder_.file("void.tif");
  MapFile declared;
  declared.no_data = -1.0;
  write(file, declared, [](int x, int y) {
    return x == 3 && y == 4 ? -1.0 : x > 40 && y > 30 ? -9999.0 : 50.0 + 0.1 * x;
  });
  const ElevationRaster part = ElevationMapFile(file).read({0, 0, 60, 50});
  EXPECT_TRUE(std::isnan(part.at(3, 45)));
  EXPECT_TRUE(std::isnan(part.at(50, 5)));
  EXPECT_EQ(part.at(30, 5), 53.0f);
}

TEST_F(MapInParts, MergedPixelsAreTheMeanOfTheirBlock) {
  const std::string name = hills({});
  const ElevationRaster whole = read_elevation_map(name).raster;
  const ElevationMapFile file(name);
  EXPECT_EQ(file.merged(1).z_m, whole.z_m);
  const ElevationRaster merged = file.merged(7);
  ASSERT_EQ(merged.width, 8);
  ASSERT_EQ(merged.height, 7);
  EXPECT_DOUBLE_EQ(merged.resolution_m, 14.0);
  EXPECT_DOUBLE_EQ(merged.south_m, whole.south_m);
  for (int row = 0; row < merged.height; ++row)
    for (int column = 0; column < merged.width; ++column) {
      double sum = 0.0;
      for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 7; ++x) sum += whole.at(7 * column + x, 7 * row + y);
      EXPECT_NEAR(merged.at(column, row), sum / 49.0, 1e-4);
    }
}

TEST_F(MapInParts, ABlockWithAVoidIsVoid) {
  const std::string file = folder_.file("void.tif");
  MapFile declared;
  declared.no_data = -1.0;
  write(file, declared, [](int x, int y) { return x == 5 && y == 49 ? -1.0 : 50.0; });
  const ElevationRaster merged = ElevationMapFile(file).merged(5);
  EXPECT_TRUE(std::isnan(merged.at(1, 0)));
  EXPECT_EQ(std::count_if(merged.z_m.begin(), merged.z_m.end(), [](float z) { return std::isnan(z); }), 1);
  EXPECT_THROW(read_for_display(file), DtmError);
}

TEST_F(MapInParts, BlocksKeepTheLimit) {
  ElevationRaster frame;
  frame.width = frame.height = 12650;
  EXPECT_EQ(blocks_for(frame, 200'000'000), 1);
  EXPECT_EQ(blocks_for(frame, 16'000'000), 4);
  EXPECT_EQ(blocks_for(frame, 4'000'000), 7);
}

TEST_F(MapInParts, AMapThatIsNotInMetresIsRefused) {
  MapFile degrees;
  degrees.reference = testing_support::kMars;
  degrees.transform = {137.0, 1e-5, 0.0, 40.0, 0.0, -1e-5};
  const std::string line = refusal(hills(degrees));
  EXPECT_NE(line.find("is not in metres, north up (60 x 50 pixels"), std::string::npos) << line;
  EXPECT_NE(line.find("gdalwarp -t_srs"), std::string::npos) << line;
  EXPECT_NE(refusal(folder_.file("none.tif")).find("not found"), std::string::npos);
}

TEST_F(MapInParts, AMapThatIsCutOffFailsWhereItIsRead) {
  const std::string name = hills({});
  const ElevationMapFile file(name);
  fs::resize_file(name, fs::file_size(name) / 2);
  EXPECT_THROW(file.read({0, 0, 60, 50}), DtmError);
}

// GDAL looks for a grid's projection beside the grid.
TEST_F(MapInParts, ALinkIsReadWithTheSideFilesOfItsTarget) {
  const fs::path dir = folder_.path() / "maps";
  fs::create_directory(dir);
  std::ofstream(dir / "grid.asc") << "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 2\n1 2 3\n4 5 6\n";
  std::ofstream(dir / "grid.prj") << testing_support::mars_plane();
  fs::create_symlink(dir / "grid.asc", folder_.path() / "orbital_map.tif");
  const ElevationMapFile file(folder_.file("orbital_map.tif"));
  EXPECT_EQ(file.read({0, 0, 3, 1}).z_m, (std::vector<float>{4, 5, 6}));
}

// A picture in degrees with another pixel size lands on the map's ground, in the map's projection.
TEST_F(MapInParts, PictureIsPlacedOnTheMap) {
  const ElevationRaster map = read_elevation_map(hills(MapFile{})).raster;
  const double degree = 180.0 / (3.141592653589793 * testing_support::kMarsRadiusM);
  MapFile picture;
  picture.reference = testing_support::kMars;
  picture.transform = {1000.0 * degree, 0.5 * degree, 0.0, 5000.0 * degree, 0.0, -0.5 * degree};
  picture.width = 240;
  picture.height = 200;
  picture.type = GDT_Byte;
  picture.bands = 3;
  picture.change = [](GDALDataset& file) {
    std::vector<double> zeros(240);
    for (int line = 0; line < 200; ++line)  // the third band is black: the mean is two thirds
      EXPECT_EQ(
          file.GetRasterBand(3)->RasterIO(GF_Write, 0, line, 240, 1, zeros.data(), 240, 1, GDT_Float64, 0, 0, nullptr),
          CE_None);
  };
  write(folder_.file("picture.tif"), picture, [](int x, int y) { return x >= 120 ? 150.0 : y >= 100 ? 60.0 : 0.0; });
  const ElevationRaster placed = read_picture(folder_.file("picture.tif"), map);
  EXPECT_NEAR(placed.resolution_m, 0.5, 0.01);
  EXPECT_EQ(placed.west_m, map.west_m);
  EXPECT_EQ(placed.south_m, map.south_m);
  EXPECT_EQ(placed.projection_wkt, map.projection_wkt);
  const auto at = [&](double x_m, double y_m) {
    return placed.at(static_cast<int>(x_m / placed.resolution_m), static_cast<int>(y_m / placed.resolution_m));
  };
  EXPECT_NEAR(at(90.0, 50.0), 100.0, 0.5) << "east";
  EXPECT_NEAR(at(30.0, 25.0), 40.0, 0.5) << "south-west";
  EXPECT_NEAR(at(30.0, 75.0), 0.0, 0.5) << "north-west: black is no void";
}

TEST_F(MapInParts, PictureOfOtherGroundIsRefused) {
  const ElevationRaster map = read_elevation_map(hills(MapFile{})).raster;
  MapFile elsewhere;
  elsewhere.transform = {9000.0, 0.5, 0.0, 5000.0, 0.0, -0.5};
  elsewhere.type = GDT_Byte;
  write(folder_.file("elsewhere.tif"), elsewhere, [](int, int) { return 80.0; });
  try {
    read_picture(folder_.file("elsewhere.tif"), map);
    ADD_FAILURE() << "accepted";
  } catch (const DtmError& error) {
    EXPECT_EQ(folder_.short_names(error.what()), "elsewhere.tif: shows nothing of the map's ground");
  }
}

}  // namespace
}  // namespace rover
