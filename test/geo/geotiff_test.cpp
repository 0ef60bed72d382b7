// GeoTIFFs written by the project.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/geo/elevation_map.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "map_files.hpp"
#include "test/common/temp_folder.hpp"

namespace rover {
namespace {

using testing_support::kGale;

TEST(GeoTiff, GaleIsReadFromTheSouthWest) {
  const ElevationRaster raster = read_elevation_map(kGale).raster;
  EXPECT_DOUBLE_EQ(raster.resolution_m, 1.0);
  EXPECT_NE(raster.projection_wkt.find("Mars"), std::string::npos);
  const auto [low, high] = std::minmax_element(raster.z_m.begin(), raster.z_m.end());
  EXPECT_GT(*low, -4700.0f);
  EXPECT_LT(*high, -4300.0f);
  EXPECT_GT(*high - *low, 10.0f);
}

TEST(GeoTiff, WhatIsWrittenIsRead) {
  const testing_support::TempFolder folder;
  const ElevationRaster raster = read_elevation_map(kGale).raster;
  write_geotiff(folder.file("copy.tif"), raster);
  const ElevationRaster copy = read_elevation_map(folder.file("copy.tif")).raster;
  EXPECT_EQ(copy.width, raster.width);
  EXPECT_EQ(copy.z_m, raster.z_m);
  EXPECT_DOUBLE_EQ(copy.west_m, raster.west_m);
  EXPECT_DOUBLE_EQ(copy.south_m, raster.south_m);
  EXPECT_DOUBLE_EQ(copy.resolution_m, raster.resolution_m);
  EXPECT_NE(copy.projection_wkt.find("Mars"), std::string::npos);
}

TEST(GeoTiff, UnwritablePlaceIsNamed) {
  const testing_support::TempFolder folder;
  EXPECT_THROW(write_geotiff(folder.file("no_such_folder/map.tif"), read_elevation_map(kGale).raster), DtmError);
}

}  // namespace
}  // namespace rover
