// Detection of voids that the file does not declare.
#include "common/geo/undeclared_voids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/core/frames.hpp"
#include "common/geo/elevation_map.hpp"

namespace rover {
namespace {

template <class F>
ElevationRaster raster_of(int width, int height, F&& height_m) {
  ElevationRaster raster;
  raster.width = width;
  raster.height = height;
  raster.resolution_m = 1.0;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) raster.z_m.push_back(static_cast<float>(height_m(column, row)));
  return raster;
}

double hills(double x, double y) {
  return 2000.0 + 0.1 * x + 3.0 * std::sin(x / 9.0) + 2.0 * std::cos(y / 7.0);
}

std::int64_t voids_in(const ElevationRaster& raster) {
  return std::count_if(raster.z_m.begin(), raster.z_m.end(), [](float z) { return std::isnan(z); });
}

// Expects no void.
void expect_ground(ElevationRaster raster, double pixel_m = 1.0) {
  const std::int64_t before = voids_in(raster);
  const UndeclaredVoids found = remove_undeclared_voids(raster, pixel_m);
  EXPECT_EQ(found.problem, "");
  EXPECT_EQ(voids_in(raster), before);
}

TEST(UndeclaredVoids, APlateauBehindAWallIsVoid) {
  for (const float value : {-32768.0F, -9999.0F, 0.0F, -3276.8F, 32767.0F}) {
    ElevationRaster raster = raster_of(80, 60, [&](int x, int y) { return x < 20 ? value : hills(x, y); });
    const UndeclaredVoids found = remove_undeclared_voids(raster, 1.0);
    EXPECT_EQ(found.problem, "");
    ASSERT_EQ(found.plateaus.size(), 1u) << value;
    EXPECT_EQ(found.plateaus[0].height_m, value);
    EXPECT_EQ(found.plateaus[0].pixels, 20 * 60);
    EXPECT_EQ(voids_in(raster), 20 * 60);
    EXPECT_TRUE(std::isfinite(raster.at(20, 30)));
  }
}

TEST(UndeclaredVoids, SeveralValuesAndScatteredPixelsAreVoid) {
  ElevationRaster raster = raster_of(80, 60, [](int x, int y) {
    if (x < 10) return -9999.0;
    if (x >= 70) return 0.0;
    return (x * 7 + y * 13) % 97 == 0 ? -32768.0 : hills(x, y);
  });
  const UndeclaredVoids found = remove_undeclared_voids(raster, 1.0);
  EXPECT_EQ(found.problem, "");
  EXPECT_EQ(found.plateaus.size(), 2u);
  EXPECT_GT(found.interpolated, 20);
  EXPECT_TRUE(std::all_of(raster.z_m.begin(), raster.z_m.end(),
                          [](float z) { return std::isnan(z) || (z > 1900.0F && z < 2100.0F); }));
}

// As after bilinear resampling without void handling.
TEST(UndeclaredVoids, InterpolatedPixelsAtTheirEdgeAreVoid) {
  ElevationRaster raster = raster_of(80, 60, [](int x, int y) {
    const double void_fraction = std::clamp((20.3 + 0.37 * (y % 5) - x), 0.0, 1.0);
    return void_fraction * -9999.0 + (1.0 - void_fraction) * hills(x, y);
  });
  const UndeclaredVoids found = remove_undeclared_voids(raster, 1.0);
  EXPECT_EQ(found.problem, "");
  EXPECT_GT(found.interpolated, 40);
  EXPECT_TRUE(std::all_of(raster.z_m.begin(), raster.z_m.end(),
                          [](float z) { return std::isnan(z) || (z > 1900.0F && z < 2100.0F); }));
}

TEST(UndeclaredVoids, WhereItCannotBeKnownTheHeightsAreNamed) {
  ElevationRaster raster = raster_of(80, 60, [](int x, int y) { return x < 30 ? hills(x, y) - 9000.0 : hills(x, y); });
  const UndeclaredVoids found = remove_undeclared_voids(raster, 1.0);
  EXPECT_NE(found.problem.find("1999 to 2012 m"), std::string::npos) << found.problem;
  EXPECT_NE(found.problem.find("-7002 to -6993 m"), std::string::npos) << found.problem;
  EXPECT_NE(found.problem.find("column 0, line 59"), std::string::npos) << found.problem;
  // Two exact heights: each could be the void of the other.
  ElevationRaster flat = raster_of(80, 60, [](int x, int) { return x < 30 ? -9999.0 : 5.0; });
  EXPECT_NE(remove_undeclared_voids(flat, 1.0).problem, "");
}

TEST(UndeclaredVoids, APictureIsNoTerrain) {
  ElevationRaster raster = raster_of(80, 60, [](int x, int y) { return (x * 7919 + y * 104729) % 900; });
  EXPECT_NE(remove_undeclared_voids(raster, 0.25).problem.find("45 deg"), std::string::npos);
}

TEST(UndeclaredVoids, GroundStaysGround) {
  expect_ground(raster_of(80, 60, [](int, int) { return 5.0; }));
  expect_ground(raster_of(80, 60, [](int x, int y) { return x < 30 ? hills(x, y) - 40.0 : hills(x, y); }));  // a cliff
  expect_ground(raster_of(80, 60, [](int x, int y) { return x < 30 ? hills(x, y) - 400.0 : hills(x, y); }));
  expect_ground(raster_of(80, 60, [](int x, int y) { return std::round(hills(x, y)); }));
  // A sea at 0 with a coast of 20 m, and a lake of one exact height.
  expect_ground(raster_of(80, 60, [](int x, int y) { return x < 30 ? 0.0 : hills(x, y) - 1980.0; }));
  expect_ground(
      raster_of(80, 60, [](int x, int y) { return std::hypot(x - 40, y - 30) < 12.0 ? 1995.0 : hills(x, y); }));
  // 20 km of relief at 463 m a pixel: a shield volcano with an escarpment of 6 km over three pixels.
  expect_ground(raster_of(400, 300,
                          [](int x, int y) {
                            const double r = std::hypot(x - 200, y - 150);
                            return -8000.0 + 20000.0 * std::exp(-r / 60.0) +
                                   6000.0 * std::clamp((100.0 - r) / 3.0, 0.0, 1.0);
                          }),
                463.0);
  // An island in declared voids.
  expect_ground(raster_of(80, 60, [](int x, int y) {
    const double r = std::hypot(x - 40, y - 30);
    return r > 3.0 && r < 9.0 ? kNaN : hills(x, y);
  }));
}

TEST(UndeclaredVoids, MeasuredTerrainStaysGround) {
  const std::string root = ROVER_SOURCE_DIR;
  for (const std::string& file :
       {root + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif", root + "/../shared/data/gale/ctx_dtm_20m.tif"}) {
    if (!std::filesystem::exists(file)) continue;
    const ElevationMap map = read_elevation_map(file);
    EXPECT_TRUE(map.notes.empty()) << map.notes.front();
  }
}

}  // namespace
}  // namespace rover
