// Slopes and path checks on terrain of known slope.
#include "mission_control/ground_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "common/core/frames.hpp"

namespace rover::mission {
namespace {

constexpr SlopeLimits kSlopeLimits{0.1745, 0.2618};  // 10 and 15 deg

// Flat in the west, rising eastwards by the slope beyond x = 40 m.
GroundMap ramp(double slope_rad, double resolution_m = 1.0) {
  GroundHeights heights{static_cast<int>(80 / resolution_m), static_cast<int>(60 / resolution_m), resolution_m, {}};
  for (int row = 0; row < heights.rows; ++row)
    for (int column = 0; column < heights.columns; ++column)
      heights.z_m.push_back(
          static_cast<float>(std::max(0.0, (column + 0.5) * resolution_m - 40.0) * std::tan(slope_rad)));
  return GroundMap(heights, kSlopeLimits, 1.75);
}

TEST(GroundMap, SlopeOfAPlane) {
  for (const double resolution : {0.5, 1.0}) {
    const GroundMap map = ramp(0.2, resolution);
    const PathCheck flat = map.check({{5, 5}, {30, 50}});
    EXPECT_TRUE(flat.inside && flat.passable);
    EXPECT_NEAR(flat.max_slope_rad, 0.0, 1e-6);
    EXPECT_NEAR(flat.length_m, std::hypot(25, 45), 1e-9);
    const PathCheck up = map.check({{50, 30}, {70, 30}});
    EXPECT_NEAR(up.max_slope_rad, 0.2, 1e-4);
    EXPECT_TRUE(up.passable);
  }
}

TEST(GroundMap, RefusesSteepSlopeAnywhereOnPath) {
  const GroundMap map = ramp(0.3);
  EXPECT_TRUE(map.check({{5, 5}, {35, 5}}).passable);
  EXPECT_FALSE(map.check({{5, 5}, {60, 5}, {5, 20}}).passable);
  EXPECT_FALSE(map.check({{5, 5}, {60, 5}}).passable) << "across a cliff between two waypoints";
}

TEST(GroundMap, RefusesPointsOutsideMap) {
  const GroundMap map = ramp(0.0);
  EXPECT_TRUE(map.check({{0, 0}, {79.9, 59.9}}).inside);
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(-1, 5), {81, 5}, {5, -0.1}, {5, 60.0}, {1e6, 1e6}}) {
    EXPECT_FALSE(map.check({{5, 5}, p}).inside) << p.transpose();
    EXPECT_FALSE(map.check({p, {5, 5}}).inside) << p.transpose();
  }
  EXPECT_FALSE(map.check({{5, 5}, {100, 5}, {6, 5}}).inside) << "out and back";
}

TEST(GroundMap, ProfileFollowsPath) {
  const PathCheck check = ramp(0.2).check({{10, 10}, {20, 10}, {20, 15}});
  ASSERT_GT(check.distance_m.size(), 30U);
  EXPECT_EQ(check.distance_m.size(), check.slope_rad.size());
  EXPECT_EQ(check.distance_m.size(), check.height_m.size());
  EXPECT_DOUBLE_EQ(check.distance_m.front(), 0.0);
  EXPECT_NEAR(check.distance_m.back(), 15.0, 1e-9);
  EXPECT_TRUE(std::is_sorted(check.distance_m.begin(), check.distance_m.end()));
}

TEST(GroundMap, DifficultyDilatesSlopeByRoverLength) {
  const GroundMap map = ramp(0.3);
  const cv::Mat slope = cv::imdecode(map.slope_png(), cv::IMREAD_UNCHANGED);
  const cv::Mat difficulty = cv::imdecode(map.difficulty_png(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(slope.size(), cv::Size(80, 60));
  ASSERT_EQ(difficulty.size(), slope.size());
  EXPECT_EQ(slope.at<cv::Vec4b>(30, 10)[3], 0) << "flat ground is transparent";
  EXPECT_GT(slope.at<cv::Vec4b>(30, 70)[3], 150);
  EXPECT_NE(difficulty.at<cv::Vec4b>(30, 10), difficulty.at<cv::Vec4b>(30, 70));
  EXPECT_EQ(difficulty.at<cv::Vec4b>(30, 41), difficulty.at<cv::Vec4b>(30, 70));
  EXPECT_FALSE(cv::imdecode(map.relief_jpeg(), cv::IMREAD_COLOR).empty());
}

}  // namespace
}  // namespace rover::mission
