// Arcs, body axes and the footprint against sums of small steps and brute force.
#include "path_planner/geometry.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/randoms.hpp"

namespace rover::planning {
namespace {

using testing_support::random_pose;
using testing_support::uniform;

TEST(Geometry, AnArcIsTheLimitOfSmallSteps) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 start = random_pose(random, 5.0);
    const double curvature = uniform(random, -1.0, 1.0);
    const double length_m = uniform(random, -3.0, 3.0);
    Pose2 sum = start;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double middle = sum.yaw_rad + 0.5 * curvature * length_m / kSteps;
      sum.x_m += length_m / kSteps * std::cos(middle);
      sum.y_m += length_m / kSteps * std::sin(middle);
      sum.yaw_rad += curvature * length_m / kSteps;
    }
    const Pose2 end = advanced(start, length_m, curvature);
    EXPECT_NEAR(distance(position(end), position(sum)), 0.0, 1e-7);
    EXPECT_NEAR(end.yaw_rad, sum.yaw_rad, 1e-9);
  }
}

TEST(Geometry, InReverseAnArcLeadsToItsStart) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose2 start = random_pose(random, 5.0);
    const double curvature = i == 0 ? 0.0 : uniform(random, -1.0, 1.0);
    const Pose2 back = advanced(advanced(start, 2.0, curvature), -2.0, curvature);
    EXPECT_NEAR(distance(position(back), position(start)), 0.0, 1e-12);
    EXPECT_NEAR(back.yaw_rad, start.yaw_rad, 1e-12);
  }
}

TEST(Geometry, BodyAxesAreForwardAndLeft) {
  const Pose2 north{3.0, 4.0, 0.5 * kPi};
  const Point2 ahead = to_body(north, {3.0, 6.0});
  EXPECT_NEAR(ahead.x_m, 2.0, 1e-12);
  EXPECT_NEAR(ahead.y_m, 0.0, 1e-12);
  EXPECT_NEAR(to_body(north, {2.0, 4.0}).y_m, 1.0, 1e-12);
}

double brute_distance_m(const Footprint& f, Point2 p) {
  double least = kInfinity;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = 2.0 * i / kSteps - 1.0;
    for (const double side : {-1.0, 1.0}) {
      least = std::min(least, distance(p, {u * f.half_length_m, side * f.half_width_m}));
      least = std::min(least, distance(p, {side * f.half_length_m, u * f.half_width_m}));
    }
  }
  const bool inside = std::abs(p.x_m) < f.half_length_m && std::abs(p.y_m) < f.half_width_m;
  return inside ? -least : least;
}

TEST(Geometry, DistanceToTheFootprintIsThatToTheNearestPointOfItsEdge) {
  std::mt19937_64 random(3);
  const Footprint footprint{0.875, 0.47};
  for (int i = 0; i < 300; ++i) {
    const Point2 p{uniform(random, -2.0, 2.0), uniform(random, -2.0, 2.0)};
    EXPECT_NEAR(footprint.distance_m(p), brute_distance_m(footprint, p), 1e-3) << p.x_m << " " << p.y_m;
  }
}

}  // namespace
}  // namespace rover::planning
