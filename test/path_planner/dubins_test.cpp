// Laws of the shortest arc-line-arc paths on random pairs of poses.
#include "path_planner/dubins.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/randoms.hpp"

namespace rover::planning {
namespace {

using testing_support::random_pose;
using testing_support::uniform;

Pose2 end_of(const Pose2& start, const DubinsPath& path) {
  Pose2 pose = start;
  for (const ArcSegment& arc : path.segments) pose = advanced(pose, arc.length_m, arc.curvature_per_m);
  return pose;
}

struct Pair {
  Pose2 from;
  Pose2 to;
  double radius_m = 1.0;
};

std::vector<Pair> random_pairs(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Pair> pairs;
  for (int i = 0; i < 5000; ++i) {
    const Pose2 from = random_pose(random, 5.0);
    const Pose2 to = random_pose(random, 5.0);
    pairs.push_back({from, to, uniform(random, 0.5, 3.0)});
  }
  return pairs;
}

TEST(Dubins, MeetsTheEndPose) {
  for (const Pair& p : random_pairs(1)) {
    const auto path = dubins_path(p.from, p.to, p.radius_m);
    ASSERT_TRUE(path);
    const Pose2 end = end_of(p.from, *path);
    ASSERT_NEAR(distance(position(end), position(p.to)), 0.0, 1e-7);
    ASSERT_NEAR(wrap_angle(end.yaw_rad - p.to.yaw_rad), 0.0, 1e-7);
  }
}

TEST(Dubins, KeepsTheRadiusAndDrivesForward) {
  for (const Pair& p : random_pairs(2)) {
    const auto path = dubins_path(p.from, p.to, p.radius_m);
    ASSERT_TRUE(path);
    EXPECT_EQ(path->segments[1].curvature_per_m, 0.0);
    for (const ArcSegment& arc : path->segments) {
      ASSERT_GE(arc.length_m, 0.0);
      ASSERT_LE(std::abs(arc.curvature_per_m), 1.0 / p.radius_m + 1e-12);
      ASSERT_TRUE(arc.curvature_per_m == 0.0 || arc.length_m <= 2.0 * kPi * p.radius_m + 1e-9);
    }
  }
}

TEST(Dubins, IsNeverShorterThanTheStraightLine) {
  for (const Pair& p : random_pairs(3))
    ASSERT_GE(dubins_path(p.from, p.to, p.radius_m)->length_m(), distance(position(p.from), position(p.to)) - 1e-9);
}

TEST(Dubins, ThePathInReverseIsAsLong) {
  for (const Pair& p : random_pairs(4)) {
    const Pose2 from{p.to.x_m, p.to.y_m, p.to.yaw_rad + kPi};
    const Pose2 to{p.from.x_m, p.from.y_m, p.from.yaw_rad + kPi};
    ASSERT_NEAR(dubins_path(p.from, p.to, p.radius_m)->length_m(), dubins_path(from, to, p.radius_m)->length_m(), 1e-6);
  }
}

TEST(Dubins, TheMirrorImageIsAsLong) {
  for (const Pair& p : random_pairs(5)) {
    const auto mirrored = [](const Pose2& pose) { return Pose2{pose.x_m, -pose.y_m, -pose.yaw_rad}; };
    ASSERT_NEAR(dubins_path(p.from, p.to, p.radius_m)->length_m(),
                dubins_path(mirrored(p.from), mirrored(p.to), p.radius_m)->length_m(), 1e-6);
  }
}

// Random arc-line-arc paths that meet the same end are never shorter.
TEST(Dubins, NoOtherArcLineArcIsShorter) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 20000; ++i) {
    const Pose2 from = random_pose(random, 5.0);
    const double radius = uniform(random, 0.5, 3.0);
    const double first = random() % 2 ? 1.0 / radius : -1.0 / radius;
    const double last = random() % 2 ? 1.0 / radius : -1.0 / radius;
    const DubinsPath tried{{ArcSegment{first, uniform(random, 0.0, 2.0 * kPi * radius)},
                            ArcSegment{0.0, uniform(random, 0.0, 5.0)},
                            ArcSegment{last, uniform(random, 0.0, 2.0 * kPi * radius)}}};
    const auto path = dubins_path(from, end_of(from, tried), radius);
    ASSERT_TRUE(path);
    ASSERT_LE(path->length_m(), tried.length_m() + 1e-6);
  }
}

TEST(Dubins, KnownPaths) {
  EXPECT_NEAR(dubins_path({0, 0, 0}, {4, 0, 0}, 1.0)->length_m(), 4.0, 1e-9);
  EXPECT_NEAR(dubins_path({0, 0, 0}, {0, 2, kPi}, 1.0)->length_m(), kPi, 1e-9);
  EXPECT_NEAR(dubins_path({0, 0, 0}, {1, 1, 0.5 * kPi}, 1.0)->length_m(), 0.5 * kPi, 1e-9);
  EXPECT_NEAR(dubins_path({1, 2, 0.7}, {1, 2, 0.7}, 1.0)->length_m(), 0.0, 1e-6);
}

}  // namespace
}  // namespace rover::planning
