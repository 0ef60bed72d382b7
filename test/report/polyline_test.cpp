#include "tools/report/polyline.hpp"

#include <gtest/gtest.h>

namespace rover::report {
namespace {

const Points kCorner = {{0, 0}, {4, 0}, {4, 3}};

TEST(Polyline, LengthAndDistance) {
  EXPECT_DOUBLE_EQ(length_m(kCorner), 7.0);
  EXPECT_DOUBLE_EQ(length_m({}), 0.0);
  EXPECT_DOUBLE_EQ(distance_m(kCorner, {2, 1.5}), 1.5);
  EXPECT_DOUBLE_EQ(distance_m(kCorner, {7, 7}), 5.0);
  EXPECT_EQ(distance_m({}, {0, 0}), std::numeric_limits<double>::infinity());
}

TEST(Polyline, PartAheadBeginsAtTheFootAndHasTheLength) {
  const Points part = part_ahead(kCorner, {3, -2}, 2.5);
  ASSERT_EQ(part.size(), 3u);
  EXPECT_EQ(part.front(), Eigen::Vector2d(3, 0));
  EXPECT_EQ(part.back(), Eigen::Vector2d(4, 1.5));
  EXPECT_DOUBLE_EQ(length_m(part_ahead(kCorner, {3, -2}, 100.0)), 4.0);
  EXPECT_TRUE(part_ahead({}, {0, 0}, 1.0).empty());
}

TEST(Polyline, DistanceToABox) {
  EXPECT_DOUBLE_EQ(distance_to_box_m({0.5, -0.2}, 0.8, 0.4), 0.0);
  EXPECT_DOUBLE_EQ(distance_to_box_m({1.1, 0.0}, 0.8, 0.4), 1.1 - 0.8);
  EXPECT_DOUBLE_EQ(distance_to_box_m({-3.8, 4.4}, 0.8, 0.4), 5.0);
}

}  // namespace
}  // namespace rover::report
