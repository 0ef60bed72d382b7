#include "point_cloud/cloud_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rover::cloud {
namespace {

// Fronto-parallel square on a regular grid.
Cloud wall(double half_m, double step_m, double z_m) {
  Cloud cloud;
  for (double x = -half_m; x <= half_m; x += step_m)
    for (double y = -half_m; y <= half_m; y += step_m)
      cloud.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z_m), 0.02F});
  return cloud;
}

TEST(CloudFilter, EmptyCloudStaysEmpty) {
  EXPECT_TRUE(filter_cloud({}, {}).empty());
}

TEST(CloudFilter, OnePointPerVoxelWithMeanSigma) {
  Cloud cloud = wall(0.5, 0.01, 2.02);
  for (Point& p : cloud) p.depth_sigma_m = p.x_m < 0.0F ? 0.01F : 0.03F;
  const Cloud out = filter_cloud(cloud, {});
  EXPECT_NEAR(static_cast<double>(out.size()), 21.0 * 21.0, 42.0);
  for (const Point& p : out) {
    EXPECT_NEAR(p.z_m, 2.02F, 1e-5F);
    if (std::abs(p.x_m) < 0.06F) continue;
    EXPECT_NEAR(p.depth_sigma_m, p.x_m < 0.0F ? 0.01F : 0.03F, 1e-6F);
  }
}

TEST(CloudFilter, IsolatedPointsAreRemoved) {
  Cloud cloud = wall(0.5, 0.02, 3.0);
  const size_t alone = filter_cloud(cloud, {}).size();
  for (int i = 0; i < 10; ++i) cloud.push_back({2.0F + static_cast<float>(i), 0.0F, 1.0F, 0.01F});
  const Cloud out = filter_cloud(cloud, {});
  EXPECT_EQ(out.size(), alone);
  for (const Point& p : out) EXPECT_LT(p.x_m, 1.0F);
}

TEST(CloudFilter, KeepsNearestPointsAboveTheLimit) {
  Cloud cloud = wall(1.0, 0.05, 2.0);
  const Cloud far = wall(1.0, 0.05, 6.0);
  cloud.insert(cloud.begin(), far.begin(), far.end());
  const size_t all = filter_cloud(cloud, {}).size();
  const Cloud out = filter_cloud(cloud, {.max_points = static_cast<int>(all / 2)});
  ASSERT_EQ(out.size(), all / 2);
  for (const Point& p : out) EXPECT_NEAR(p.z_m, 2.0F, 0.01F);
}

TEST(CloudFilter, SameCloudGivesIdenticalResult) {
  std::mt19937_64 random(3);
  Cloud cloud;
  for (int i = 0; i < 30000; ++i) {
    const auto draw = [&] { return static_cast<float>(random() % 4000) / 1000.0F; };
    cloud.push_back({draw(), draw(), draw(), draw()});
  }
  const Cloud a = filter_cloud(cloud, {}), b = filter_cloud(cloud, {});
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].x_m, b[i].x_m);
    ASSERT_EQ(a[i].depth_sigma_m, b[i].depth_sigma_m);
  }
}

}  // namespace
}  // namespace rover::cloud
