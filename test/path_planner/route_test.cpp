// Routes measured by their arc length, and the rounding of their corners.
#include "path_planner/route.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/randoms.hpp"

namespace rover::planning {
namespace {

using testing_support::uniform;

Route route_of(const std::vector<Point2>& points) {
  std::vector<RoutePoint> out;
  for (const Point2& p : points) out.push_back({p, kNaN, 0});
  return Route(out);
}

std::vector<RoutePoint> corners_of(const std::vector<Point2>& points) {
  return route_of(points).points();
}

Route circle(double radius_m, double turn_rad) {
  std::vector<Point2> points;
  const int count = static_cast<int>(std::ceil(radius_m * turn_rad / 0.1));
  for (int i = 0; i <= count; ++i) {
    const double a = turn_rad * i / count;
    points.push_back({radius_m * std::sin(a), radius_m * (1.0 - std::cos(a))});
  }
  return route_of(points);
}

std::vector<Point2> random_corners(std::mt19937_64& random) {
  std::vector<Point2> points = {{0.0, 0.0}};
  double heading = 0.0;
  for (int i = 0; i < 6; ++i) {
    heading += uniform(random, -1.5, 1.5);
    const double length_m = uniform(random, 2.0, 8.0);
    points.push_back(
        {points.back().x_m + length_m * std::cos(heading), points.back().y_m + length_m * std::sin(heading)});
  }
  return points;
}

double distance_to(const Route& route, Point2 p) {
  return distance(route.point_at(route.closest(p)), p);
}

TEST(Route, OnACircleThePoseIsThatOfTheCircle) {
  const Route route = circle(2.0, 2.5);
  for (double s = 0.0; s <= route.length_m(); s += 0.037) {
    const Pose2 exact = advanced({0.0, 0.0, 0.0}, s * 5.0 / route.length_m(), 0.5);
    const Pose2 pose = route.pose_at(s);
    EXPECT_NEAR(distance(position(pose), position(exact)), 0.0, 0.002);  // sagitta of 0.1 m
    EXPECT_NEAR(pose.yaw_rad, exact.yaw_rad, 0.002);
  }
  EXPECT_TRUE(route.corners().empty());
}

TEST(Route, TheHeadingJumpsOnlyAtCorners) {
  const Route route = route_of({{0, 0}, {2, 0}, {2, 2}, {4, 2.2}});
  ASSERT_EQ(route.corners().size(), 2u);
  EXPECT_EQ(route.corners()[0], 1u);
  EXPECT_NEAR(route.yaw_into(1), 0.0, 1e-12);
  EXPECT_NEAR(route.yaw_out_of(1), 0.5 * kPi, 1e-12);
  EXPECT_NEAR(route.pose_at(2.0 - 1e-9).yaw_rad, 0.0, 1e-6);
  EXPECT_NEAR(route.pose_at(2.0).yaw_rad, 0.5 * kPi, 1e-12);
  EXPECT_EQ(route.segment_at(1.9).end_m, 2.0);
  EXPECT_EQ(route.segment_at(2.0).begin_m, 2.0);
}

TEST(Route, AtACuspTheBodyKeepsItsHeading) {
  const Route route(
      {{{0, 0}, kNaN, 0, false}, {{2, 0}, kNaN, 0, true}, {{1, 0.1}, kNaN, 0, true}, {{0, 0.4}, kNaN, 0}});
  EXPECT_TRUE(route.corners().empty());
  EXPECT_NEAR(route.pose_at(0.5).yaw_rad, 0.0, 0.1);
  EXPECT_NEAR(route.pose_at(2.5).yaw_rad, -0.15, 0.1);
  const PathSegment there = route.segment_at(1.99), back = route.segment_at(2.0);
  EXPECT_FALSE(there.reverse);
  EXPECT_TRUE(back.reverse);
  EXPECT_EQ(there.begin_m, 0.0);
  EXPECT_EQ(there.end_m, 2.0);
  EXPECT_EQ(back.begin_m, 2.0);
  EXPECT_EQ(back.end_m, route.length_m());
  EXPECT_EQ(route.segment_at(100.0).end_m, route.length_m());
}

TEST(Route, BeyondItsEndsTheRouteIsItsEndPoint) {
  const Route route = route_of({{0, 0}, {1, 0}, {2, 0}});
  EXPECT_NEAR(route.point_at(-1.0).x_m, 0.0, 1e-12);
  EXPECT_NEAR(route.point_at(9.0).x_m, 2.0, 1e-12);
  EXPECT_NEAR(route.pose_at(9.0).yaw_rad, 0.0, 1e-12);
}

TEST(Route, ClosestAgreesWithBruteForceWithinTheGivenRange) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const Route route = route_of(random_corners(random));
    const Point2 p{uniform(random, -5.0, 30.0), uniform(random, -15.0, 15.0)};
    const double from = uniform(random, 0.0, 0.7) * route.length_m();
    const double to = from + uniform(random, 0.0, 5.0);
    double best = kInfinity;
    for (double s = from; s <= std::min(to, route.length_m()); s += 0.001)
      best = std::min(best, distance(route.point_at(s), p));
    const double s = route.closest(p, from, to);
    EXPECT_GE(s, from);
    EXPECT_LE(s, to);
    EXPECT_NEAR(distance(route.point_at(s), p), best, 1e-3);
  }
}

TEST(Route, TransformedItKeepsItsShape) {
  std::mt19937_64 random(2);
  const Route route = rounded(corners_of(random_corners(random)), RoundingConfig{});
  const Pose2 T{3.0, -2.0, 1.2};
  const Route moved = transformed(route, T);
  ASSERT_EQ(moved.points().size(), route.points().size());
  EXPECT_NEAR(moved.length_m(), route.length_m(), 1e-9);
  for (size_t i = 0; i < route.points().size(); ++i) {
    const Point2 back = to_body(T, moved.points()[i].p);
    EXPECT_NEAR(distance(back, route.points()[i].p), 0.0, 1e-9);
  }
}

TEST(Rounding, StaysNearTheCornersAndKeepsTheEnds) {
  std::mt19937_64 random(3);
  const RoundingConfig config;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Point2> corners = random_corners(random);
    const Route sharp = route_of(corners);
    const Route route = rounded(corners_of(corners), config);
    EXPECT_NEAR(distance(route.points().front().p, corners.front()), 0.0, 1e-9);
    EXPECT_NEAR(distance(route.points().back().p, corners.back()), 0.0, 1e-9);
    for (const RoutePoint& point : route.points()) ASSERT_LE(distance_to(sharp, point.p), config.tolerance_m + 1e-6);
    for (const Point2& corner : corners) ASSERT_LE(distance_to(route, corner), config.tolerance_m + 0.01);
    for (size_t k = 1; k < route.points().size(); ++k)
      ASSERT_LE(distance(route.points()[k - 1].p, route.points()[k].p), config.step_m + 1e-6);
  }
}

// Between corners the curvature is that of the minimum radius or less; 5 % for arcs made of pieces.
TEST(Rounding, KeepsTheMinimumRadiusOrLeavesACorner) {
  std::mt19937_64 random(4);
  const RoundingConfig config;
  int sharp_corners = 0;
  for (int i = 0; i < 200; ++i) {
    const Route route = rounded(corners_of(random_corners(random)), config);
    sharp_corners += static_cast<int>(route.corners().size());
    for (size_t k = 1; k < route.points().size(); ++k) {
      const double bend = std::abs(route.yaw_into(k) - route.yaw_out_of(k - 1));
      // A piece shorter than a step may hold half of its neighbours' bends.
      const double length_m = std::max(route.s_at(k) - route.s_at(k - 1), config.step_m);
      ASSERT_LE(bend / length_m, 1.05 / config.min_radius_m) << i << " " << k;
    }
  }
  EXPECT_GT(sharp_corners, 100);  // turns of more than 66 deg do not fit into the tolerance with a radius of 1 m
}

TEST(Rounding, AGentleCornerGetsAWideArcAndASharpOneStays) {
  const Route gentle = rounded(corners_of({{0, 0}, {10, 0}, {20, 2}}), RoundingConfig{});
  EXPECT_TRUE(gentle.corners().empty());
  const Route sharp = rounded(corners_of({{0, 0}, {10, 0}, {10, 10}}), RoundingConfig{});
  ASSERT_EQ(sharp.corners().size(), 1u);
  EXPECT_NEAR(distance(sharp.points()[sharp.corners()[0]].p, {10, 0}), 0.0, 1e-9);
}

TEST(Rounding, ACornerGivenTwiceIsRoundedToo) {
  for (const auto& points : {corners_of({{0, 0}, {10, 0}, {16, 7}}), corners_of({{0, 0}, {10, 0}, {10, 0}, {16, 7}})})
    EXPECT_TRUE(rounded(points, RoundingConfig{}).corners().empty());
}

TEST(Rounding, LevelsStartWhereTheirPointLies) {
  std::vector<RoutePoint> corners = corners_of({{0, 0}, {5, 0}, {10, 0}});
  corners[1].level = 1;
  const Route route = rounded(corners, RoundingConfig{});
  EXPECT_EQ(route.level_at(4.8), 0);
  EXPECT_EQ(route.level_at(5.2), 1);
}

}  // namespace
}  // namespace rover::planning
