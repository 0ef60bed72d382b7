#include "point_cloud/point_cloud.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "test/point_cloud/navcam_world.hpp"

namespace rover::cloud {
namespace {

PointCloud make_cloud() {
  return PointCloud({.max_depth_m = 12.0}, navcam_rig(), navcam_unit(), kGroundBelow);
}

CloudResult cloud_of(const synthetic::World& world, double pan_rad, double tilt_rad) {
  const synthetic::RawPair pair = render_pair(world, pan_rad, tilt_rad);
  PointCloud core = make_cloud();
  return *core.step(pair.left, pair.right, pan_rad, tilt_rad);
}

// Rms height error of the points up to `max_depth_m`.
double ground_error_m(const CloudResult& result, const synthetic::World& world, double max_depth_m) {
  double squares = 0.0;
  int count = 0;
  for (const Point& point : result.cloud) {
    if (point.z_m > max_depth_m) continue;
    const Eigen::Vector3d p = in_body(result, point);
    squares += std::pow(p.z() - world.ground_m(p.x(), p.y()), 2);
    ++count;
  }
  return std::sqrt(squares / count);
}

TEST(PointCloud, FlatGroundIsAccurateFromEveryPanAndTilt) {
  struct Case {
    double pan_deg, tilt_deg;
    size_t min_points;
  };
  for (const auto& [pan_deg, tilt_deg, min_points] : {Case{0, 0, 12000}, {50, 8, 5000}, {-60, 25, 900}}) {
    const CloudResult result = cloud_of({}, to_rad(pan_deg), to_rad(tilt_deg));
    EXPECT_GT(result.cloud.size(), min_points) << pan_deg;
    EXPECT_LE(result.cloud.size(), 20000u) << pan_deg;
    EXPECT_LT(ground_error_m(result, {}, 6.0), 0.01) << pan_deg;
    EXPECT_LT(ground_error_m(result, {}, 12.0), 0.02) << pan_deg;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Point& point : result.cloud) mean += in_body(result, point) - navcam_unit().p_body_axes;
    EXPECT_NEAR(std::atan2(mean.y(), mean.x()), to_rad(pan_deg), to_rad(5.0)) << pan_deg;
  }
}

TEST(PointCloud, CoversGroundFromNearToFar) {
  const CloudResult ahead = cloud_of({}, 0.0, 0.0);
  std::array<int, 12> per_metre{};
  for (const Point& point : ahead.cloud)
    ++per_metre.at(static_cast<size_t>(std::clamp(in_body(ahead, point).x(), 0.0, 11.9)));
  for (size_t x = 3; x <= 9; ++x) EXPECT_GT(per_metre[x], 200) << x;
  const CloudResult down = cloud_of({}, 0.0, to_rad(30.0));
  double nearest_m = kInfinity;
  for (const Point& point : down.cloud) nearest_m = std::min(nearest_m, in_body(down, point).x());
  EXPECT_LT(nearest_m, 1.3);
}

TEST(PointCloud, MeasuresRocksAndSlopes) {
  synthetic::World world;
  world.slope_x = 0.2;
  world.z0_m -= 0.2 * 1.5;
  world.rocks = {{3.0, 0.2, 0.25, 0.35}};
  const CloudResult result = cloud_of(world, 0.0, 0.0);
  double highest_m = 0.0;
  for (const Point& point : result.cloud) {
    const Eigen::Vector3d p = in_body(result, point);
    if (std::hypot(p.x() - 3.0, p.y() - 0.2) < 0.25)
      highest_m = std::max(highest_m, p.z() - world.ground_m(p.x(), p.y()));
  }
  EXPECT_NEAR(highest_m, 0.35, 0.05);
  world.rocks.clear();
  EXPECT_LT(ground_error_m(cloud_of(world, 0.0, 0.0), world, 8.0), 0.02);
}

// Largest distance behind a rock's centre at which points are above the ground.
double farthest_behind_m(int rim_px) {
  constexpr double kFarM = 8.0;
  PointCloudConfig config;
  config.foreground_fattening.width_px = rim_px;
  double farthest_m = 0.0;
  for (const auto& [height_m, box] : {std::pair{0.3, true}, {0.5, false}}) {
    synthetic::World world;
    world.rocks = {{kFarM, 0.0, 0.25, height_m, box}};
    PointCloud core(config, navcam_rig(), navcam_unit(), kGroundBelow);
    const synthetic::RawPair pair = render_pair(world, 0.0, 0.0);
    const CloudResult result = *core.step(pair.left, pair.right, 0.0, 0.0);
    for (const Point& point : result.cloud) {
      const Eigen::Vector3d p = in_body(result, point);
      if (std::abs(p.y()) < 0.5 && p.z() - world.ground_m(p.x(), p.y()) > 0.1)
        farthest_m = std::max(farthest_m, p.x() - kFarM);
    }
  }
  return farthest_m;
}

TEST(PointCloud, NoPointsInTheAirBehindARock) {
  EXPECT_GT(farthest_behind_m(0), 0.4);  // without removal the defect is visible
  EXPECT_LT(farthest_behind_m(FatteningConfig{}.width_px), 0.25);
}

TEST(ForegroundFattening, RemovesOnlyTheNearSideOfAJump) {
  const FatteningConfig config{.min_jump_px = 1.5, .slope_px_per_px = 0.4, .width_px = 2};
  Disparity disparity(3, 8, 160);
  for (int v = 4; v < 8; ++v) disparity.at(0, v) = 320;                                     // a rock
  for (int v = 0; v < 8; ++v) disparity.at(1, v) = static_cast<std::int16_t>(160 + 6 * v);  // steep ground
  for (int v = 4; v < 8; ++v) disparity.at(2, v) = 320;  // a rock with an unmatched edge
  disparity.at(2, 3) = Disparity::kInvalid;
  remove_foreground_fattening(disparity, config);
  for (const int u : {0, 2}) {
    EXPECT_TRUE(disparity.valid(u, 2)) << u;
    EXPECT_FALSE(disparity.valid(u, 4)) << u;
    EXPECT_FALSE(disparity.valid(u, 5)) << u;
    EXPECT_TRUE(disparity.valid(u, 6)) << u;
  }
  for (int v = 0; v < 8; ++v) EXPECT_TRUE(disparity.valid(1, v)) << v;
}

// GA SLAM's code derives sigma from the distance to the world's origin.
TEST(PointCloud, SigmaDependsOnlyOnDepthFromCamera) {
  const CloudResult result = cloud_of({}, 0.0, 0.0);
  const double per_m2 = 0.25 / (818.0 * 0.24);
  for (const Point& point : result.cloud)
    EXPECT_NEAR(point.depth_sigma_m, 0.005 + per_m2 * point.z_m * point.z_m, 0.05 * point.depth_sigma_m + 2e-4);
  // 500 m from the origin the images and sigmas are the same.
  PointCloud core = make_cloud();
  const synthetic::RawPair pair = render_pair({}, 0.0, 0.0);
  const CloudResult here = *core.step(pair.left, pair.right, 0.0, 0.0);
  const Eigen::Isometry3d T_odom_body = make_pose(rotation_from_rpy(0.0, 0.0, 0.7), {400.0, -300.0, 5.0});
  ASSERT_EQ(here.cloud.size(), result.cloud.size());
  for (size_t i = 0; i < here.cloud.size(); ++i) {
    EXPECT_EQ(here.cloud[i].depth_sigma_m, result.cloud[i].depth_sigma_m);
    EXPECT_LT(here.cloud[i].depth_sigma_m, 1e-3 * (T_odom_body * in_body(here, here.cloud[i])).norm());
  }
}

TEST(PointCloud, TexturelessImagesGiveEmptyCloud) {
  PointCloud core = make_cloud();
  const GrayImage grey(640, 480, 90);
  const auto result = core.step(grey, grey, 0.0, 0.0);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->cloud.empty());
  EXPECT_EQ(result->valid_fraction, 0.0);
  EXPECT_TRUE(is_finite(result->T_body_cam));
}

// Grey values per second: the same for any exposure, and the image's mean.
TEST(PointCloud, PointsHaveTheBrightnessOfTheirPixels) {
  PointCloud core = make_cloud();
  const synthetic::RawPair pair = render_pair({}, 0.0, 0.0);
  const auto mean = [&](double exposure_s) {
    double sum = 0.0;
    const Cloud cloud = core.step(pair.left, pair.right, 0.0, 0.0, exposure_s)->cloud;
    for (const Point& point : cloud) sum += point.brightness;
    return sum / static_cast<double>(cloud.size());
  };
  const double grey =
      std::accumulate(pair.left.data.begin(), pair.left.data.end(), 0.0) / static_cast<double>(pair.left.data.size());
  EXPECT_NEAR(mean(0.0), grey, 0.1 * grey);
  EXPECT_NEAR(mean(0.02), 50.0 * mean(0.0), 0.01 * 50.0 * grey);
  Disparity disparity(640, 480, 16 * 40);
  for (const Point& point : core.from_disparity(disparity, 0.0, 0.0).cloud) EXPECT_TRUE(std::isnan(point.brightness));
}

TEST(PointCloud, ImageOfWrongSizeIsRejected) {
  PointCloud core = make_cloud();
  EXPECT_FALSE(core.step(GrayImage(640, 480), GrayImage(640, 479), 0.0, 0.0));
}

}  // namespace
}  // namespace rover::cloud
