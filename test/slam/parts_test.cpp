// Parts of SLAM: aligned clouds, patches, elevation map, particle filter, map anchor.
#include <gtest/gtest.h>

#include "slam/elevation_map.hpp"
#include "slam/map_anchor.hpp"
#include "slam/particle_filter.hpp"
#include "test/slam/navcam.hpp"

namespace rover::slam {
namespace {

using namespace testing_support;

Cloud view(const Ground& ground, const Pose2& pose, std::uint64_t seed, double sigma_px = 0.25) {
  NavcamModel camera;
  camera.disparity_sigma_px = sigma_px;
  Random random(seed);
  return cloud_of(ground, upright(pose, kOriginHeightM), camera, random, 1);
}

TEST(AlignedCloud, VarianceIsIndependentOfWorldPosition) {
  Cloud cloud = view({}, {}, 1);
  const AttitudeNoise noise;
  const AlignedCloud here = align_to_gravity(cloud, upright({0, 0, 0.3}, 0.6), noise);
  const AlignedCloud far_off = align_to_gravity(cloud, upright({2000, -3000, -1.0}, 250), noise);
  ASSERT_EQ(here.points.size(), far_off.points.size());
  ASSERT_GT(here.points.size(), 5000u);
  for (size_t i = 0; i < here.points.size(); ++i) {
    EXPECT_FLOAT_EQ(here.points[i].variance_m2, far_off.points[i].variance_m2);
    EXPECT_FLOAT_EQ(here.points[i].z_m, far_off.points[i].z_m);
  }
}

TEST(AlignedCloud, VarianceGrowsWithDistanceFromCamera) {
  Cloud cloud;
  cloud.T_body_cam = NavcamModel{}.T_body_cam();
  const auto sigma = [](float z) { return z * z * 0.25F / (818.0F * 0.24F); };
  for (const float z : {2.0F, 4.0F, 8.0F}) cloud.points.push_back({{0.0F, 0.1F * z, z}, sigma(z)});
  const AlignedCloud aligned = align_to_gravity(cloud, upright({}, 0.6), {.tilt_rad = 0.0015});
  EXPECT_LT(aligned.points[0].variance_m2, aligned.points[1].variance_m2);
  EXPECT_LT(aligned.points[1].variance_m2, aligned.points[2].variance_m2);
  // The ray descends by sin(17 deg) + 0.1 cos(17 deg) per metre of depth.
  const double fall = std::sin(to_rad(17)) + 0.1 * std::cos(to_rad(17));
  const double by_depth = fall * sigma(8.0F);
  const AlignedPoint& p = aligned.points[2];
  const double by_tilt = 0.0015 * std::hypot(p.x_m, p.y_m);
  EXPECT_NEAR(p.variance_m2, by_depth * by_depth + by_tilt * by_tilt + 0.003 * 0.003, 1e-7);
}

TEST(ElevationMap, CellsHaveTheBrightnessOfTheirPoints) {
  ElevationMap map({});
  const auto insert = [&](float brightness) {
    AlignedCloud cloud;
    for (int i = 0; i < 10; ++i)
      cloud.points.push_back({2.05F, 1.05F, 0.0F, 1e-4F, 0.0F, 0.0F, brightness + (i % 2 == 0 ? 10.0F : -10.0F)});
    map.insert(cloud, {{}, 0.0, 0.0});
    return map.grid().get(map.grid().index_of(2.05, 1.05)).brightness;
  };
  EXPECT_TRUE(std::isnan(insert(kNoBrightness)));
  EXPECT_NEAR(insert(80.0F), 80.0, 1e-3) << "the first cloud with a picture";
  const float both = insert(120.0F);
  EXPECT_GT(both, 85.0F);
  EXPECT_LT(both, 115.0F);
  EXPECT_EQ(insert(kNoBrightness), both) << "a cloud without one says nothing";
}

TEST(Patches, CellWithStepHasMeanAndTop) {
  AlignedCloud cloud;
  for (int i = 0; i < 10; ++i) cloud.points.push_back({2.05F, 1.05F, i < 6 ? 0.0F : 0.3F, 1e-4F, 0.0F, 0.0F});
  PatchBinner binner({});
  const auto& patches = binner.bin_cloud(cloud, {});
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_EQ(patches[0].ix, 20);
  EXPECT_EQ(patches[0].iy, 10);
  EXPECT_NEAR(patches[0].z_m, 0.12, 1e-5);
  EXPECT_NEAR(patches[0].top_m, 0.3, 1e-5);
}

TEST(Patches, SingleHighPointIsNotATop) {
  AlignedCloud cloud;
  for (int i = 0; i < 10; ++i) cloud.points.push_back({2.05F, 1.05F, i < 9 ? 0.0F : 0.3F, 1e-4F, 0.0F, 0.0F});
  PatchBinner binner({});
  const Patch patch = binner.bin_cloud(cloud, {}).at(0);
  EXPECT_FLOAT_EQ(patch.top_m, patch.z_m);
}

// Mean and worst error of the map's cells with a sigma below 2 cm.
struct MapError {
  double mean_m = 0.0, worst_m = 0.0;
  int cells = 0;
};
MapError error_of(const ElevationMap& map, const Ground& ground, double travelled_m) {
  MapError error;
  map.grid().for_each([&](CellIndex i, const ElevationCell& cell) {
    if (!cell.seen() || map.variance_m2(cell, travelled_m) > 0.02 * 0.02) return;
    const double off = cell.height_m - ground(map.grid().center_x_m(i), map.grid().center_y_m(i));
    error.mean_m += std::abs(off);
    error.worst_m = std::max(error.worst_m, std::abs(off));
    ++error.cells;
  });
  error.mean_m /= std::max(1, error.cells);
  return error;
}

ElevationMap driven_map(const Ground& ground, double to_m) {
  ElevationMap map({});
  for (double x = 0.0; x <= to_m; x += 0.5) {
    map.move_to(x, 0.0);
    map.insert(align_to_gravity(view(ground, {x, 0, 0}, static_cast<std::uint64_t>(10 * x + 1)),
                                upright({x, 0, 0}, kOriginHeightM), {}),
               {{x, 0, 0}, kOriginHeightM, x});
  }
  return map;
}

TEST(ElevationMap, StaticTerrainIsMappedWithinCentimetres) {
  const Ground ground;
  const MapError error = error_of(driven_map(ground, 8.0), ground, 8.0);
  EXPECT_GT(error.cells, 3000);
  EXPECT_LT(error.mean_m, 0.012);
}

TEST(ElevationMap, FlatGroundIsMappedWithinMillimetres) {
  const Ground ground{0.0, 0.0};
  const MapError error = error_of(driven_map(ground, 4.0), ground, 4.0);
  EXPECT_GT(error.cells, 2000);
  EXPECT_LT(error.mean_m, 0.005);
  EXPECT_LT(error.worst_m, 0.05);
}

struct RockGround {
  bool rock = true;
  double operator()(double x, double y) const { return rock && std::hypot(x - 4.0, y) < 0.3 ? 0.35 : 0.0; }
};

TEST(ElevationMap, RemovedRockIsClearedByRays) {
  ElevationMap map({});
  NavcamModel camera;
  Random random(3);
  const auto look = [&](bool rock, double travelled_m) {
    const Cloud cloud = cloud_of(RockGround{rock}, upright({}, kOriginHeightM), camera, random, 1);
    map.insert(align_to_gravity(cloud, upright({}, kOriginHeightM), {}), {{}, kOriginHeightM, travelled_m});
  };
  const auto top = [&] {
    float highest = 0.0F;
    map.grid().for_each([&](CellIndex i, const ElevationCell& cell) {
      const double x = map.grid().center_x_m(i), y = map.grid().center_y_m(i);
      if (cell.seen() && std::hypot(x - 4.0, y) < 0.5) highest = std::max(highest, cell.top_m);
    });
    return highest;
  };
  map.move_to(0, 0);
  for (int i = 0; i < 3; ++i) look(true, 0.0);
  EXPECT_NEAR(top(), 0.35, 0.03);
  for (int i = 0; i < 3; ++i) look(false, 0.0);
  EXPECT_LT(top(), 0.1);
}

TEST(ElevationMap, StandingRockIsNotClearedByRays) {
  ElevationMap map({});
  NavcamModel camera;
  Random random(3);
  map.move_to(0, 0);
  for (int i = 0; i < 6; ++i) {
    const Cloud cloud = cloud_of(RockGround{true}, upright({}, kOriginHeightM), camera, random, 1);
    map.insert(align_to_gravity(cloud, upright({}, kOriginHeightM), {}), {{}, kOriginHeightM, 0.0});
  }
  int remaining = 0;
  map.grid().for_each([&](CellIndex i, const ElevationCell& cell) {
    const double x = map.grid().center_x_m(i), y = map.grid().center_y_m(i);
    remaining += cell.seen() && x > 3.7 && x < 3.9 && std::abs(y) < 0.2 && cell.top_m > 0.25 ? 1 : 0;
  });
  EXPECT_GE(remaining, 6);
}

TEST(ElevationMap, OutlierIsAcceptedOnlyWhenRepeated) {
  ElevationMap map({});
  const auto insert_height = [&](float z, float variance) {
    AlignedCloud cloud;
    cloud.camera_m = {0, 0, 0.5F};
    for (int i = 0; i < 8; ++i) cloud.points.push_back({3.05F, 0.05F, z, variance, 0, 0});
    map.insert(cloud, {{}, 0.0, 0.0});
    return map.grid().get({30, 0}).height_m;
  };
  map.move_to(0, 0);
  insert_height(0.0F, 1e-4F);
  insert_height(0.0F, 1e-4F);
  EXPECT_NEAR(insert_height(0.5F, 1e-2F), 0.0, 1e-6);
  EXPECT_NEAR(insert_height(0.5F, 1e-2F), 0.5, 1e-6);
}

TEST(ElevationMap, VarianceGrowsWithDistanceSinceCellWasSeen) {
  const ElevationMap map = driven_map({}, 0.0);
  const ElevationCell* seen = nullptr;
  map.grid().for_each([&](CellIndex, const ElevationCell& cell) { seen = cell.seen() ? &cell : seen; });
  ASSERT_NE(seen, nullptr);
  EXPECT_FLOAT_EQ(map.variance_m2(*seen, 0.0), seen->variance_m2);
  EXPECT_NEAR(map.variance_m2(*seen, 10.0), seen->variance_m2 + 10.0 * ElevationConfig{}.growth_m2_per_m, 1e-9);
}

TEST(ElevationMap, IsIndependentOfWorldPosition) {
  const Ground flat{0.0, 0.0};
  const Cloud cloud = view(flat, {}, 5);
  const auto sum_at = [&](double x, double y) {
    ElevationMap map({});
    map.move_to(x, y);
    map.insert(align_to_gravity(cloud, upright({x, y, 0}, kOriginHeightM), {}), {{x, y, 0}, kOriginHeightM, 0.0});
    double variance = 0.0;
    map.grid().for_each([&](CellIndex, const ElevationCell& c) { variance += c.seen() ? c.variance_m2 : 0.0; });
    return variance / map.seen_cells();
  };
  EXPECT_NEAR(sum_at(5000.0, -8000.0) / sum_at(0.0, 0.0), 1.0, 1e-3);
}

TEST(ParticleFilter, BetweenIsInverseOfCompose) {
  const Pose2 a{1, 2, 2.5}, b{-3, 0.5, -2.0};
  const Pose2 c = compose(a, between(a, b));
  EXPECT_NEAR(c.x_m, b.x_m, 1e-12);
  EXPECT_NEAR(c.y_m, b.y_m, 1e-12);
  EXPECT_NEAR(wrap_angle(c.yaw_rad - b.yaw_rad), 0.0, 1e-12);
}

ParticleFilter spread_filter(Random& random, int particles = 400) {
  FilterConfig config;
  config.min_particles = config.max_particles = particles;
  ParticleFilter filter(config);
  filter.reset({10, 20, 3.1});
  filter.predict({}, {0.1, 0.1, 0.05}, random);
  return filter;
}

TEST(ParticleFilter, PosteriorIsProductOfGaussians) {
  Random random(1);
  ParticleFilter filter = spread_filter(random, 20000);
  // Prior sigma 0.1 about 0, likelihood sigma 0.1 about 0.1: mean 0.05, sigma 0.0707.
  const auto likelihood = [](const Pose2& p) { return -0.5 * std::pow((p.x_m - 10.1) / 0.1, 2); };
  filter.update(likelihood);
  EXPECT_NEAR(filter.mean().x_m, 10.05, 0.003);
  EXPECT_NEAR(filter.covariance()(0, 0), 0.005, 0.0003);
  EXPECT_NEAR(filter.mean().y_m, 20.0, 0.003);
}

TEST(ParticleFilter, VeryNegativeLogWeightsDoNotUnderflow) {
  Random random(1);
  ParticleFilter filter = spread_filter(random);
  filter.update([](const Pose2& p) { return -1e6 - 0.5 * std::pow((p.x_m - 10.0) / 0.05, 2); });
  EXPECT_TRUE(std::isfinite(filter.mean().x_m));
  EXPECT_GT(filter.effective_particles(), 50.0);
  EXPECT_NEAR(filter.mean().x_m, 10.0, 0.02);
}

TEST(ParticleFilter, ResamplingKeepsMeanAndCovariance) {
  Random random(7);
  ParticleFilter filter = spread_filter(random, 4000);
  filter.update([](const Pose2& p) { return -0.5 * std::pow((p.x_m - 10.1) / 0.03, 2); });
  const Pose2 mean = filter.mean();
  const double variance = filter.covariance()(0, 0);
  ASSERT_LT(filter.effective_particles(), 0.5 * 4000);
  filter.resample(random);
  EXPECT_NEAR(filter.effective_particles(), static_cast<double>(filter.particles().size()), 1e-6);
  EXPECT_NEAR(filter.mean().x_m, mean.x_m, 0.001);
  EXPECT_NEAR(filter.covariance()(0, 0), variance, 0.1 * variance);
}

TEST(ParticleFilter, NoResamplingWithEnoughEffectiveParticles) {
  Random random(7);
  ParticleFilter filter = spread_filter(random);
  filter.update([](const Pose2& p) { return -0.5 * std::pow((p.x_m - 10.0) / 0.3, 2); });
  const double effective_particles = filter.effective_particles();
  filter.resample(random);
  EXPECT_DOUBLE_EQ(filter.effective_particles(), effective_particles);
}

TEST(ParticleFilter, ParticleCountFollowsSpread) {
  const auto resampled = [](double sigma_m) {
    Random random(7);
    FilterConfig config;
    config.min_particles = 100;
    config.max_particles = 1000;
    ParticleFilter filter(config);
    filter.reset({});
    filter.predict({}, {sigma_m, sigma_m, 0.0}, random);
    filter.update([&](const Pose2& p) { return -std::pow(p.x_m / (0.3 * sigma_m), 2); });
    filter.resample(random);
    return filter.particles().size();
  };
  EXPECT_LT(resampled(0.001), 150u);
  EXPECT_GT(resampled(0.05), 300u);
}

TEST(ParticleFilter, MeanYawHandlesWrapAround) {
  Random random(3);
  FilterConfig config;
  ParticleFilter filter(config);
  filter.reset({0, 0, kPi});
  filter.predict({}, {0, 0, 0.1}, random);
  EXPECT_LT(std::abs(wrap_angle(filter.mean().yaw_rad - kPi)), 0.04);
  EXPECT_NEAR(std::sqrt(filter.covariance()(2, 2)), 0.1, 0.03);
}

class AnchorTest : public testing::Test {
 protected:
  bool add_pose(const Pose2& T_map_odom, const Pose2& body = {10, 0, 0}) {
    t_ += kTickUs;
    return anchor_.add_pose(t_, from_planar(T_map_odom), from_planar(body));
  }
  MapAnchor anchor_{AnchorConfig{}};
  Utime t_ = 0;
};

TEST_F(AnchorTest, StartsAtPose) {
  EXPECT_FALSE(add_pose({5, 6, 1.0}));
  anchor_.anchor({});
  const Pose2 T = anchor_.T_map_odom({});
  EXPECT_DOUBLE_EQ(T.x_m, 5);
  EXPECT_DOUBLE_EQ(T.yaw_rad, 1.0);
  const Pose2 drifted = anchor_.T_map_odom({1, 0, 0});
  EXPECT_NEAR(drifted.x_m, 5 + std::cos(1.0), 1e-12);
}

TEST_F(AnchorTest, SlowFollowingOfSlamIsNotACorrection) {
  add_pose({5, 6, 1.0});
  anchor_.anchor({});
  for (int i = 1; i < 200; ++i) EXPECT_FALSE(add_pose({5 + 0.0004 * i, 6, 1.0}));
}

TEST_F(AnchorTest, CorrectionIsDetectedAndAdopted) {
  add_pose({5, 6, 1.0});
  anchor_.anchor({});
  const Pose2 drift{0.3, -0.2, 0.02};
  EXPECT_TRUE(add_pose({5.4, 6.1, 1.01}));
  anchor_.anchor(drift);
  const Pose2 T = anchor_.T_map_odom(drift);
  EXPECT_NEAR(T.x_m, 5.4, 1e-12);
  EXPECT_NEAR(T.y_m, 6.1, 1e-12);
  EXPECT_NEAR(T.yaw_rad, 1.01, 1e-12);
}

TEST_F(AnchorTest, RotationAboutTheRoverIsACorrection) {
  add_pose({0, 0, 0});
  const Pose2 body{10, 0, 0};
  // map turned about the rover by 0.01 rad: the rover's position in map does not change.
  const Pose2 turned{10 - 10 * std::cos(0.01), -10 * std::sin(0.01), 0.01};
  EXPECT_TRUE(add_pose(turned, body));
}

}  // namespace
}  // namespace rover::slam
