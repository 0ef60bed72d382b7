#include "trajectory_control/tracked_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/trajectory_control/drive_loop.hpp"

namespace rover::control {
namespace {

PathInput input(std::vector<Eigen::Vector2d> points, double corridor_half_width_m = 0.75) {
  return {1, corridor_half_width_m, std::move(points)};
}

// A lower bound below the configured one: the steering rate limits the speed in more places.
TrackedPathConfig slow_config() {
  TrackedPathConfig config;
  config.min_speed_mps = 0.06;
  return config;
}

TrackedPath tracked(std::vector<Eigen::Vector2d> points, double corridor_half_width_m = 0.75) {
  return TrackedPath::build(input(std::move(points), corridor_half_width_m), slow_config()).value();
}

TEST(TrackedPath, RejectsInvalidPaths) {
  const TrackedPathConfig config = slow_config();
  EXPECT_FALSE(TrackedPath::build(input({}), config));
  EXPECT_FALSE(TrackedPath::build(input({{1.0, 1.0}}), config));
  EXPECT_FALSE(TrackedPath::build(input({{1.0, 1.0}, {1.0, 1.0}}), config));
  EXPECT_FALSE(TrackedPath::build(input({{1.0, 1.0}, {kNaN, 2.0}}), config));
  EXPECT_FALSE(TrackedPath::build(input({{1.0, 1.0}, {kInfinity, 2.0}}), config));
  EXPECT_FALSE(TrackedPath::build(input({{1.0, 1.0}, {1e9, 2.0}}), config));
  for (const double width : {0.0, -1.0, kNaN, kInfinity})
    EXPECT_FALSE(TrackedPath::build({1, width, {{0.0, 0.0}, {5.0, 0.0}}}, config)) << width;
}

TEST(TrackedPath, TwoPointsMakeAPath) {
  const TrackedPath path = tracked({{0.0, 0.0}, {0.0, 7.0}});
  EXPECT_NEAR(path.length_m(), 7.0, 1e-9);
  ASSERT_EQ(path.segments().size(), 1u);
  EXPECT_NEAR(path.segments()[0].at(3.0).yaw_rad, kPi / 2.0, 1e-9);
  EXPECT_NEAR(path.segments()[0].at(3.0).curvature_per_m, 0.0, 1e-9);
}

TEST(TrackedPath, CurvatureOfACircleIsItsInverseRadius) {
  const TrackedPath path = tracked(test::polyline({{0.5, 10.0}}));
  for (double s = 1.0; s < 9.0; s += 0.1) EXPECT_NEAR(path.segments()[0].at(s).curvature_per_m, 0.5, 0.04) << s;
}

TEST(TrackedPath, HeadingIsContinuousThroughAFullTurn) {
  const TrackedPath path = tracked(test::polyline({{0.5, 14.0}}));
  const auto& samples = path.segments()[0].samples();
  for (size_t i = 1; i < samples.size(); ++i) EXPECT_LT(std::abs(samples[i].yaw_rad - samples[i - 1].yaw_rad), 0.1);
  EXPECT_NEAR(samples.back().yaw_rad, 7.0, 0.05);
}

TEST(TrackedPath, IsSplitAtSharpCornersOnly) {
  EXPECT_EQ(tracked(test::polyline({{0.0, 3.0}, {0.8, 2.0}, {-0.8, 2.0}, {0.0, 3.0}})).segments().size(), 1u);
  EXPECT_EQ(tracked({{0, 0}, {4, 0}, {8, 1}}).segments().size(), 1u);
  const TrackedPath corner = tracked({{0, 0}, {4, 0}, {4, 4}});
  ASSERT_EQ(corner.segments().size(), 2u);
  EXPECT_NEAR(corner.segments()[0].length_m(), 4.0, 0.051);
  EXPECT_NEAR(corner.segments()[1].start_m(), 4.0, 0.051);
  EXPECT_NEAR(corner.length_m(), 8.0, 1e-9);
  EXPECT_NEAR(corner.segments()[1].at(0.5).yaw_rad, kPi / 2.0, 0.02);
  EXPECT_EQ(tracked({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0.5}}).segments().size(), 4u);
}

TEST(TrackedPath, SpeedIsZeroAtSegmentEndsAndRespectsTheDeceleration) {
  const TrackedPathConfig config = slow_config();
  const TrackedPath path = tracked({{0, 0}, {4, 0}, {4, 4}});
  for (const PathSegment& segment : path.segments()) {
    EXPECT_EQ(segment.samples().back().speed_mps, 0.0);
    const double step = segment.length_m() / static_cast<double>(segment.samples().size() - 1);
    for (size_t i = 1; i < segment.samples().size(); ++i) {
      const double v0 = segment.samples()[i - 1].speed_mps;
      const double v1 = segment.samples()[i].speed_mps;
      EXPECT_LE((v0 * v0 - v1 * v1) / (2.0 * step), config.deceleration_mps2 + 1e-9);
    }
  }
}

TEST(TrackedPath, OuterWheelSpeedIsLimited) {
  TrackedPathConfig config = slow_config();
  config.max_wheel_speed_mps = 0.22;
  const TrackedPath path = TrackedPath::build(input(test::polyline({{0.8, 6.0}})), config).value();
  const PathSample middle = path.segments()[0].at(3.0);
  EXPECT_NEAR(middle.speed_mps * std::hypot(1.0 + 0.8 * 0.41, 0.8 * 0.75), 0.22, 0.01);
}

TEST(TrackedPath, SteeringRateCanFollowTheCurvatureAtTheProfileSpeed) {
  const TrackedPathConfig config = slow_config();
  const TrackedPath path = tracked(test::polyline(test::seed_traverse()));
  const PathSegment& segment = path.segments()[0];
  for (double s = 0.2; s < segment.length_m() - 0.3; s += 0.05) {
    const double change = std::abs(segment.at(s + 0.05).curvature_per_m - segment.at(s - 0.05).curvature_per_m) / 0.1;
    const double speed = segment.at(s).speed_mps;
    if (speed > config.min_speed_mps + 1e-9) {
      EXPECT_LT(change * speed, 1.25 * config.max_curvature_rate) << s;
    }
  }
}

TEST(Projection, MatchesBruteForce) {
  const TrackedPath path = tracked(test::polyline({{0.3, 4.0}, {-0.5, 4.0}}));
  const PathSegment& segment = path.segments()[0];
  for (double x = -0.5; x < 6.0; x += 0.37)
    for (double y = -1.0; y < 3.0; y += 0.41) {
      double nearest = kInfinity;
      for (double s = 0.0; s <= segment.length_m(); s += 0.002)
        nearest = std::min(nearest, (segment.at(s).p - Eigen::Vector2d(x, y)).norm());
      const Projection found = segment.project({x, y}, 0.0, segment.length_m());
      EXPECT_NEAR(found.distance_m, nearest, 2e-3) << x << ' ' << y;
    }
}

TEST(Projection, LeftIsPositiveAndEndsAreExtrapolated) {
  const TrackedPath path = tracked({{0.0, 0.0}, {5.0, 0.0}});
  const PathSegment& segment = path.segments()[0];
  EXPECT_NEAR(segment.project({2.0, 0.3}, 0.0, 5.0).cross_track_m, 0.3, 1e-9);
  EXPECT_NEAR(segment.project({2.0, -0.3}, 0.0, 5.0).cross_track_m, -0.3, 1e-9);
  const Projection before = segment.project({-0.4, 0.1}, 0.0, 5.0);
  EXPECT_NEAR(before.beyond_m, -0.4, 1e-9);
  EXPECT_NEAR(before.cross_track_m, 0.1, 1e-9);
  const Projection after = segment.project({5.6, -0.1}, 0.0, 5.0);
  EXPECT_NEAR(after.beyond_m, 0.6, 1e-9);
  EXPECT_NEAR(after.cross_track_m, -0.1, 1e-9);
}

double located_m(const TrackedPath& path, const Pose2& pose) {
  const PathPosition position = path.locate(pose);
  return path.segments()[position.segment].start_m() + position.s_m;
}

TEST(Locate, AtItsBeginningAPathBeginsAlthoughItsEndIsThereTooAndAligned) {
  for (const double back_y_m : {0.0, 0.1})
    for (const double corridor_m : {0.25, 1.5}) {
      const TrackedPath path = tracked({{0, 0}, {10, 0}, {10, back_y_m}, {0, back_y_m}}, corridor_m);
      EXPECT_NEAR(located_m(path, {0.0, 0.1, kPi}), 0.0, 0.1);
      EXPECT_NEAR(located_m(path, {0.3, 0.1, kPi}), 0.3, 0.1);
    }
  const TrackedPath loop = tracked({{0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 0}}, 1.5);
  EXPECT_NEAR(located_m(loop, {0.0, 0.0, -0.5 * kPi}), 0.0, 0.1);
}

// Of a restarted controller.
TEST(Locate, MidwayTheHeadingTellsWhichOfTwoPartsIsDriven) {
  const TrackedPath path = tracked({{0, 0}, {10, 0}, {10, 0.1}, {0, 0.1}});
  EXPECT_NEAR(located_m(path, {5.0, 0.05, 0.0}), 5.0, 0.1);
  EXPECT_NEAR(located_m(path, {5.0, 0.05, kPi}), 15.1, 0.1);
}

// The path starts across the rover's heading (a point turn); its second segment is aligned but outside the corridor.
TEST(Locate, StartsAtTheRoverEvenIfAPointTurnComesFirst) {
  const TrackedPath path = tracked({{0, 0}, {0, -0.3}, {-2, -0.3}}, 0.25);
  const PathPosition position = path.locate({0.01, 0.0, kPi + 0.3});
  EXPECT_EQ(position.segment, 0u);
  EXPECT_NEAR(position.s_m, 0.0, 0.05);
}

TEST(Locate, HeadingDoesNotShiftThePositionAlongABend) {
  std::vector<Eigen::Vector2d> circle;
  for (double angle = 0.0; angle <= kPi; angle += 0.1) circle.emplace_back(std::sin(angle), 1.0 - std::cos(angle));
  const TrackedPath path = tracked(circle, 0.25);
  EXPECT_NEAR(path.locate({0.0, 0.0, 0.5 * kPi}).s_m, 0.0, 0.05);
}

}  // namespace
}  // namespace rover::control
