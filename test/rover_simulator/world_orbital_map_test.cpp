#include <gtest/gtest.h>

#include <cmath>

#include "rover_simulator/world/noise.hpp"
#include "world_fixture.hpp"

namespace rover {
namespace {

ElevationRaster hills() {
  ElevationRaster raster = level_raster(120);
  raster.west_m = 1000.0;
  raster.south_m = -500.0;
  raster.projection_wkt = "LOCAL_CS[\"test\"]";
  for (int row = 0; row < raster.height; ++row)
    for (int column = 0; column < raster.width; ++column)
      raster.at(column, row) = static_cast<float>(1.5 * gradient_noise(3, column / 25.0, row / 25.0));
  return raster;
}

struct Difference {
  double mean = 0.0, rms = 0.0;
};

Difference difference(const ElevationRaster& map, const World& world) {
  Difference d;
  int count = 0;
  for (int row = 4; row < map.height - 4; ++row)
    for (int column = 4; column < map.width - 4; ++column, ++count) {
      const double e = map.at(column, row) -
                       world.smooth_height_m((column + 0.5) * map.resolution_m, (row + 0.5) * map.resolution_m);
      d.mean += e;
      d.rms += e * e;
    }
  d.mean /= count;
  d.rms = std::sqrt(d.rms / count);
  return d;
}

TEST(OrbitalMap, EqualsBoxMeanWithoutErrors) {
  WorldConfig config = bare_config();
  config.orbital = {.smoothing_px = 0.0, .vertical_noise_m = 0.0, .distortion_m = 0.0};
  const World world(config, hills(), 1);
  const ElevationRaster map = world.orbital_map(1.0);
  EXPECT_EQ(map.width, 120);
  EXPECT_EQ(map.height, 120);
  const Difference d = difference(map, world);
  EXPECT_LT(d.rms, 0.01);
}

TEST(OrbitalMap, HasGeoreference) {
  const World world(bare_config(), hills(), 1);
  const ElevationRaster map = world.orbital_map(0.5);
  EXPECT_EQ(map.width, 240);
  EXPECT_EQ(map.resolution_m, 0.5);
  EXPECT_EQ(map.west_m, 1000.0);
  EXPECT_EQ(map.south_m, -500.0);
  EXPECT_EQ(map.projection_wkt, "LOCAL_CS[\"test\"]");
}

// The error has about the configured rms and zero mean.
TEST(OrbitalMap, ErrorMatchesConfiguration) {
  const World world(bare_config(), hills(), 1);
  const Difference d = difference(world.orbital_map(1.0), world);
  EXPECT_NEAR(d.mean, 0.0, 0.02);
  EXPECT_GT(d.rms, 0.07);
  EXPECT_LT(d.rms, 0.16);
}

// Distortion alone moves features: the error is the shift times the slope.
TEST(OrbitalMap, DistortionShiftsFeaturesLocally) {
  WorldConfig config = bare_config();
  config.orbital = {.smoothing_px = 0.0, .vertical_noise_m = 0.0, .distortion_m = 0.5, .distortion_wave_m = 40.0};
  const World world(config, plane_raster(120, 120, 1.0, std::atan(0.1), 0.0), 1);
  const Difference d = difference(world.orbital_map(1.0), world);
  EXPECT_NEAR(d.mean, 0.0, 0.01);
  EXPECT_NEAR(d.rms, 0.05, 0.015);
}

TEST(OrbitalMap, IsDeterministicForSameSeed) {
  const World a(WorldConfig{}, hills(), 4), b(WorldConfig{}, hills(), 4), other(WorldConfig{}, hills(), 5);
  EXPECT_EQ(a.orbital_map(1.0).z_m, b.orbital_map(1.0).z_m);
  EXPECT_NE(a.orbital_map(1.0).z_m, other.orbital_map(1.0).z_m);
}

}  // namespace
}  // namespace rover
