// The ground from above, and the picture that an orbiter makes of it.
#include "rover_simulator/camera/ground_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "camera_test_world.hpp"
#include "rover_simulator/orbital_picture.hpp"

namespace rover {
namespace {

// A block of 1 x 1 m, 0.5 m high, on level ground.
class Block : public Surface {
 public:
  double height_m(double x, double y) const override {
    return std::abs(x - 10.0) < 0.5 && std::abs(y - 10.0) < 0.5 ? 0.5 : 0.0;
  }
  Material material(double, double) const override { return {Soil::kFirm, -1, 0.0}; }
};

GroundAppearanceConfig under_sun(double elevation_deg, double azimuth_deg) {
  GroundAppearanceConfig look;
  look.textureless_fraction = 0.0;
  look.sun_elevation_rad = to_rad(elevation_deg);
  look.sun_azimuth_rad = to_rad(azimuth_deg);
  return look;
}

double mean(const ElevationRaster& picture, double x0_m, double y0_m, double side_m) {
  double sum = 0.0;
  int count = 0;
  for (double y = y0_m; y < y0_m + side_m; y += picture.resolution_m)
    for (double x = x0_m; x < x0_m + side_m; x += picture.resolution_m, ++count)
      sum += picture.at(static_cast<int>(x / picture.resolution_m), static_cast<int>(y / picture.resolution_m));
  return sum / count;
}

TEST(GroundPicture, ShadowsFallAwayFromTheSun) {
  struct Side {
    double azimuth_deg, x_m, y_m;
  };
  // The shadow of 0.5 m under a sun at 30 deg is 0.87 m long.
  for (const auto& [azimuth_deg, x_m, y_m] : {Side{0, 8.9, 9.8}, {90, 9.8, 8.9}, {180, 10.8, 9.8}, {-90, 9.8, 10.8}}) {
    const ElevationRaster picture = ground_picture(Block{}, under_sun(30, azimuth_deg), 20.0, 20.0, 1);
    const double open = mean(picture, 3.0, 3.0, 3.0);
    EXPECT_LT(mean(picture, x_m, y_m, 0.4), 0.6 * open) << azimuth_deg;
    EXPECT_GT(mean(picture, 20.0 - x_m - 0.4, 20.0 - y_m - 0.4, 0.4), 0.8 * open) << azimuth_deg;
  }
}

TEST(GroundPicture, SlopesTowardsTheSunAreBright) {
  const auto slope = [](double azimuth_deg) {
    return mean(ground_picture(test::PlaneSurface(0.0, 0.3, 0.0), under_sun(40, azimuth_deg), 20.0, 20.0, 1), 2, 2, 16);
  };
  EXPECT_GT(slope(180), 1.3 * slope(0)) << "the ground rises to the east";
}

TEST(GroundPicture, IsTheSameOnAnyNumberOfThreads) {
  const ElevationRaster one = ground_picture(test::RockySurface(), under_sun(40, 130), 21.3, 14.0, 1);
  EXPECT_EQ(one.width, 213);
  EXPECT_EQ(one.height, 140);
  EXPECT_EQ(one.z_m, ground_picture(test::RockySurface(), under_sun(40, 130), 21.3, 14.0, 3).z_m);
}

WorldConfig with_distortion(double distortion_m) {
  WorldConfig config;
  config.orbital.distortion_m = distortion_m;
  return config;
}

TEST(OrbitalPicture, LiesOnTheOrbitalMap) {
  const ElevationRaster dtm = plane_raster(40, 30, 1.0, 0.05, 0.0);
  const World world(with_distortion(0.0), dtm, 3);
  const ElevationRaster picture = orbital_picture(world, {.resolution_m = 0.5}, under_sun(40, 130), 1);
  EXPECT_EQ(picture.width, 80);
  EXPECT_EQ(picture.height, 60);
  EXPECT_EQ(picture.west_m, world.orbital_map(1.0).west_m);
  double sum = 0.0;
  for (const float grey : picture.z_m) {
    EXPECT_EQ(grey, std::round(grey));
    EXPECT_GE(grey, 0.0F);
    EXPECT_LE(grey, 255.0F);
    sum += grey / static_cast<double>(picture.z_m.size());
  }
  EXPECT_NEAR(sum, 100.0, 3.0);
  EXPECT_NE(picture.z_m,
            orbital_picture(world, {.resolution_m = 0.5, .sun_azimuth_rad = 2.0}, under_sun(40, 130), 1).z_m);
  EXPECT_EQ(picture.z_m, orbital_picture(world, {.resolution_m = 0.5}, under_sun(20, -50), 2).z_m)
      << "its own sun, not the cameras'";
}

// Where the map is displaced, so is the picture.
TEST(OrbitalPicture, HasTheDistortionOfTheMap) {
  const ElevationRaster dtm = plane_raster(60, 60, 1.0, 0.0, 0.0);
  const World straight(with_distortion(0.0), dtm, 3), bent(with_distortion(0.6), dtm, 3);
  const OrbitalPictureConfig config{.resolution_m = 0.25, .noise = 0.0};
  const ElevationRaster a = orbital_picture(straight, config, under_sun(40, 130), 1);
  const ElevationRaster b = orbital_picture(bent, config, under_sun(40, 130), 1);
  const OrbitalShift shift = bent.shift_in(b);
  double same = 0.0, undone = 0.0;
  for (int row = 20; row < b.height - 20; ++row)
    for (int column = 20; column < b.width - 20; ++column) {
      const size_t i = static_cast<size_t>(row) * b.width + column;
      const int from_column = column + static_cast<int>(std::lround(shift.x_m[i] / 0.25));
      const int from_row = row + static_cast<int>(std::lround(shift.y_m[i] / 0.25));
      same += std::abs(b.z_m[i] - a.z_m[i]);
      undone += std::abs(b.z_m[i] - a.at(from_column, from_row));
    }
  EXPECT_LT(undone, 0.6 * same);
}

}  // namespace
}  // namespace rover
