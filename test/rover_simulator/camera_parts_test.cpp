// Unit tests of the camera parts against known values.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "camera_test_world.hpp"
#include "rover_simulator/camera/calibration_error.hpp"
#include "rover_simulator/camera/detail_texture.hpp"
#include "rover_simulator/camera/imager.hpp"
#include "rover_simulator/camera/ray_table.hpp"
#include "rover_simulator/camera/sun_horizon.hpp"
#include "rover_simulator/camera/worker_pool.hpp"

namespace rover {
namespace {

TEST(WorkerPool, ProcessesEachIndexOnce) {
  for (int threads : {1, 2, 5}) {
    WorkerPool pool(threads);
    for (int count : {0, 1, 7, 100}) {
      std::vector<std::atomic<int>> done(static_cast<size_t>(count));
      pool.run(count, [&](int i) { ++done[i]; });
      for (const auto& times : done) EXPECT_EQ(times, 1);
    }
  }
}

TEST(RayTable, ProjectionInvertsRays) {
  const StereoRig rig = test::loccam_rig();
  for (int v = 0; v < rig.height; v += 17) {
    for (int u = 0; u < rig.width; u += 13) {
      const Eigen::Vector2d pixel(u, v);
      EXPECT_LT((project(rig.right, 3.0 * ray_of_pixel(rig.right, pixel)) - pixel).norm(), 1e-6);
    }
  }
}

// Diagonal field of view of 100 deg.
TEST(RayTable, ProjectionInvertsFisheyeRays) {
  StereoRig rig = test::loccam_rig();
  rig.right.model = DistortionModel::kEquidistant;
  rig.right.distortion = {0.02, -0.015, 0.004, -0.001};
  rig.right.fx_px = rig.right.fy_px = 370.0;
  for (int v = 0; v <= rig.height; v += 16)
    for (int u = 0; u <= rig.width; u += 16) {
      const Eigen::Vector2d pixel(u, v);
      EXPECT_LT((project(rig.right, 3.0 * ray_of_pixel(rig.right, pixel)) - pixel).norm(), 1e-6);
      EXPECT_TRUE(has_ray(rig.right, pixel));
    }
  rig.right.fx_px = rig.right.fy_px = 200.0;
  EXPECT_FALSE(has_ray(rig.right, {0.0, 0.0})) << "91 deg from the axis";
}

TEST(CalibrationError, HasConfiguredReprojectionError) {
  const StereoRig nominal = test::loccam_rig();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const StereoRig rig = with_calibration_error(nominal, 0.2, seed);
    EXPECT_NEAR(reprojection_rms_px(nominal, rig), 0.2, 0.002) << seed;
    EXPECT_TRUE(rig.T_body_left.isApprox(nominal.T_body_left));
  }
  const StereoRig a = with_calibration_error(nominal, 0.2, 1);
  const StereoRig b = with_calibration_error(nominal, 0.2, 2);
  EXPECT_NE(a.left.cx_px, b.left.cx_px);
  EXPECT_LT(reprojection_rms_px(nominal, with_calibration_error(nominal, 0.0, 1)), 1e-9);
}

TEST(CalibrationError, MountingIsTurnedAboutTheLeftCamera) {
  const StereoRig nominal = test::loccam_rig();
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const StereoRig rig = with_mounting_error(nominal, 0.001, seed);
    EXPECT_EQ(rig.T_body_left.translation(), nominal.T_body_left.translation());
    EXPECT_EQ(rig.left.cx_px, nominal.left.cx_px);
    sum += log_so3(rig.T_body_left.linear() * nominal.T_body_left.linear().transpose()).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum / 300), 0.001, 0.00015);
  EXPECT_TRUE(with_mounting_error(nominal, 0.0, 1).T_body_left.isApprox(nominal.T_body_left, 1e-12));
}

TEST(DetailTexture, IsPeriodicWithZeroMeanAndUnitVariance) {
  const DetailTexture texture(3, true);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kSize = DetailTexture::kSize;
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) {
      const float value = texture.sample(static_cast<float>(u), static_cast<float>(v))[0];
      sum += value;
      squares += value * value;
    }
  }
  EXPECT_NEAR(sum / (kSize * kSize), 0.0, 0.02);
  EXPECT_NEAR(squares / (kSize * kSize), 1.0, 0.03);
  for (float at : {0.3F, 77.9F, 511.6F})
    EXPECT_NEAR(texture.sample(at, 12.25F)[0], texture.sample(at - 1024.0F, 12.25F + 512.0F)[0], 5e-3);
}

// A plateau half a metre high from x = 2 m on, seen against a sun in the east: its shadow reaches west by height / tan.
class PlateauSurface : public Surface {
 public:
  double height_m(double x, double) const override { return x >= 1.999 ? 0.5 : 0.0; }
  Material material(double, double) const override { return {}; }
};

TEST(SunHorizon, ShadowLengthFollowsSunElevation) {
  const PlateauSurface surface;
  for (double elevation_deg : {20.0, 35.0, 60.0}) {
    GroundAppearanceConfig sun;
    sun.sun_elevation_rad = to_rad(elevation_deg);
    sun.sun_azimuth_rad = 0.0;
    const auto tile = [&](int ix, int iy) { return std::make_shared<const HeightTile>(TileKey{0, ix, iy}, surface); };
    const std::vector<float> margins = sun_margins({tile(0, 0), tile(1, 0), tile(0, 1), tile(1, 1)}, sun);
    const double edge_m = 2.0 - 0.5 / std::tan(sun.sun_elevation_rad);
    const int row = 50 * (kLevels[0].cells + 1);
    for (int i = 0; i < 100; ++i) {
      const double x = i * kLevels[0].spacing_m;
      if (std::abs(x - edge_m) < 0.03 + 0.04 * (2.0 - edge_m)) continue;  // the march's steps
      EXPECT_EQ(margins[row + i]<0.0F, x> edge_m) << elevation_deg << ' ' << x;
    }
    EXPECT_GT(margins[row + 150], 0.0F);
  }
}

TEST(Imager, NoiseMatchesShotAndReadNoiseModel) {
  ImagerConfig config;
  config.vignetting = 0.0;
  const Imager imager(config, 256, 128);
  RadianceImage radiance(256, 128);
  for (double grey : {20.0, 120.0, 220.0}) {
    std::fill(radiance.data.begin(), radiance.data.end(),
              static_cast<float>(grey / (255.0 * config.radiance_per_second)));
    GrayImage image(256, 128);
    for (int v = 0; v < 128; ++v) imager.expose_row(radiance, 1.0, 99, v, image);
    double squares = 0.0;
    for (std::uint8_t value : image.data) squares += (value - grey) * (value - grey);
    const double electrons = grey * config.full_well_e / 255.0;
    const double sigma = std::sqrt(electrons + config.read_noise_e * config.read_noise_e) * 255.0 / config.full_well_e;
    EXPECT_NEAR(mean_grey(image), grey, 0.05);
    EXPECT_NEAR(squares / static_cast<double>(image.data.size()), sigma * sigma + 1.0 / 12.0, 0.05 * sigma * sigma);
  }
}

TEST(Imager, ExposureControlConvergesToTarget) {
  const ImagerConfig config;
  for (double light : {0.5, 2.0, 20.0}) {  // grey value per millisecond
    double exposure_s = 0.004;
    for (int i = 0; i < 10; ++i)
      exposure_s = next_exposure_s(config, exposure_s, std::min(1e3 * light * exposure_s, 255.0));
    EXPECT_NEAR(1e3 * light * exposure_s, light == 0.5 ? 50.0 : config.exposure_target, 2.0) << light;
  }
  EXPECT_EQ(next_exposure_s(config, 0.01, 0.0), config.exposure_max_s);
  EXPECT_EQ(next_exposure_s(config, config.exposure_min_s, 255.0), config.exposure_min_s);
}

}  // namespace
}  // namespace rover
