#include <gtest/gtest.h>

#include <cmath>

#include "common/core/frames.hpp"
#include "rover_simulator/world/noise.hpp"
#include "world_fixture.hpp"

namespace rover {
namespace {

ElevationRaster rugged_raster() {
  ElevationRaster raster = level_raster(40);
  for (int row = 0; row < raster.height; ++row)
    for (int column = 0; column < raster.width; ++column)
      raster.at(column, row) = static_cast<float>(-4500.0 + 2.0 * gradient_noise(3, column / 9.0, row / 9.0));
  return raster;
}

TEST(WorldHeight, ReproducesAPlane) {
  const double slope = to_rad(12.0), toward = to_rad(30.0);
  const World world(bare_config(), plane_raster(50, 40, 1.0, slope, toward), 1);
  const double gx = std::tan(slope) * std::cos(toward), gy = std::tan(slope) * std::sin(toward);
  for (double x : {3.0, 10.37, 41.9})
    for (double y : {5.5, 20.21, 33.3}) EXPECT_NEAR(world.height_m(x, y), gx * (x - 0.5) + gy * (y - 0.5), 2e-5);
}

TEST(WorldHeight, InterpolatesElevationModelRelativeToMinimum) {
  const ElevationRaster raster = rugged_raster();
  const World world(bare_config(), raster, 1);
  float lowest = raster.z_m[0];
  for (float z : raster.z_m) lowest = std::min(lowest, z);
  EXPECT_FLOAT_EQ(static_cast<float>(world.datum_m()), lowest);
  for (int row = 0; row < raster.height; row += 3)
    for (int column = 0; column < raster.width; column += 3)
      EXPECT_NEAR(world.height_m(column + 0.5, row + 0.5), raster.at(column, row) - lowest, 1e-6);
}

TEST(WorldHeight, SlopeIsContinuousAcrossPixels) {
  const World world(bare_config(), rugged_raster(), 1);
  constexpr double kH = 1e-4;
  for (int pixel = 4; pixel < 36; ++pixel)
    for (double y : {7.7, 18.5, 30.1}) {
      const double x = pixel + 0.5;
      const double left = (world.height_m(x, y) - world.height_m(x - kH, y)) / kH;
      const double right = (world.height_m(x + kH, y) - world.height_m(x, y)) / kH;
      EXPECT_NEAR(left, right, 1e-3);
    }
}

TEST(WorldHeight, ExtendsFlatOutsideElevationModel) {
  const World world(bare_config(), rugged_raster(), 1);
  EXPECT_EQ(world.height_m(-50, 20.5), world.height_m(0.2, 20.5));
  EXPECT_EQ(world.height_m(90, 20.5), world.height_m(39.9, 20.5));
  EXPECT_FALSE(world.contains(-0.1, 20));
  EXPECT_TRUE(world.contains(39.9, 0.0));
}

// Firm ground varies by 1 to 1.5 cm over 0.3 m, below hazard size.
TEST(WorldRoughness, MatchesFirmGround) {
  WorldConfig config = bare_config();
  config.roughness = RoughnessConfig{};
  const World world(config, level_raster(100), 6);
  double squares = 0.0, most = 0.0;
  int count = 0;
  for (double x = 5; x < 95; x += 0.23)
    for (double y = 5; y < 95; y += 0.71) {
      const double step = world.height_m(x + 0.3, y) - world.height_m(x, y);
      squares += step * step;
      most = std::max(most, std::abs(step));
      ++count;
    }
  const double rms = std::sqrt(squares / count);
  EXPECT_GT(rms, 0.010);
  EXPECT_LT(rms, 0.015);
  EXPECT_LT(most, 0.08);
}

TEST(WorldRoughness, IsSmootherOnSandAndRougherOnBedrock) {
  const auto spread = [](Soil soil) {
    WorldConfig config = bare_config();
    config.roughness = RoughnessConfig{};
    config.soil.everywhere = soil;
    const World world(config, level_raster(40), 6);
    double squares = 0.0;
    for (double x = 1; x < 39; x += 0.1) squares += std::pow(world.height_m(x, 20.3), 2);
    return std::sqrt(squares);
  };
  EXPECT_LT(spread(Soil::kSand), 0.6 * spread(Soil::kFirm));
  EXPECT_GT(spread(Soil::kBedrock), 1.2 * spread(Soil::kFirm));
}

TEST(WorldSoil, SoilFractionsMatchConfigurationOnLevelGround) {
  WorldConfig config = bare_config();
  config.soil = SoilConfig{};
  config.soil.sand_fraction = 0.2;
  config.soil.bedrock_fraction = 0.1;
  const World world(config, level_raster(800), 3);
  std::array<double, 3> share{};
  for (double x = 1; x < 800; x += 2)
    for (double y = 1; y < 800; y += 2) share[static_cast<size_t>(world.material(x, y).soil)] += 1.0 / (400.0 * 400.0);
  EXPECT_NEAR(share[0], 0.2, 0.04);
  EXPECT_NEAR(share[2], 0.1, 0.03);
}

TEST(WorldSoil, SteepGroundIsBedrockWithoutSand) {
  WorldConfig config = bare_config();
  config.soil = SoilConfig{};
  config.soil.sand_fraction = 0.9;
  const World steep(config, plane_raster(60, 60, 1.0, to_rad(20), 0.0), 3);
  const World inclined(config, plane_raster(60, 60, 1.0, to_rad(12), 0.0), 3);
  for (double x = 5; x < 55; x += 1.7) {
    EXPECT_EQ(steep.material(x, 30).soil, Soil::kBedrock);
    EXPECT_NE(inclined.material(x, 30).soil, Soil::kSand);
  }
}

TEST(WorldMaterial, RocksAreBedrockWithTheirHeight) {
  WorldConfig config = bare_config();
  config.rocks.k = 0.1;
  const World world(config, level_raster(40), 3);
  const std::vector<Rock> rocks = world.rocks_in(5, 5, 35, 35);
  ASSERT_GT(rocks.size(), 300u);
  for (const Rock& rock : rocks) {
    const Material material = world.material(rock.x_m, rock.y_m);
    EXPECT_EQ(material.soil, Soil::kBedrock);
    EXPECT_GE(material.rock_id, 0);
    EXPECT_NEAR(world.height_m(rock.x_m, rock.y_m) - world.ground_height_m(rock.x_m, rock.y_m), material.rock_height_m,
                1e-9);
  }
}

TEST(WorldSeed, DeterminesAllRandomness) {
  WorldConfig config;
  const ElevationRaster raster = rugged_raster();
  const World a(config, raster, 1), again(config, raster, 1), b(config, raster, 2);
  int same = 0;
  for (double x = 1; x < 39; x += 0.37) {
    EXPECT_EQ(a.height_m(x, 17.3), again.height_m(x, 17.3));
    EXPECT_EQ(a.smooth_height_m(x, 17.3), b.smooth_height_m(x, 17.3));
    same += a.height_m(x, 17.3) == b.height_m(x, 17.3);
  }
  EXPECT_EQ(same, 0);
}

}  // namespace
}  // namespace rover
