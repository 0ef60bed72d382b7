// The driven track, to back up to, also when the rover backs up beside it.
#include "path_planner/breadcrumbs.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

Point2 on_arc(double angle_rad, double radius_m) {
  return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad))};
}

Breadcrumbs straight_track(double length_m) {
  Breadcrumbs track;
  for (double x = 0.0; x <= length_m; x += 0.05) track.extend({x, 0.0});
  return track;
}

TEST(Breadcrumbs, LieOnTheDrivenTrack) {
  const std::deque<Point2> points = straight_track(3.0).points();
  EXPECT_NEAR(points.front().x_m, 0.0, 1e-9);
  EXPECT_NEAR(points.back().x_m, 3.0, 0.11);
  for (size_t i = 1; i < points.size(); ++i) EXPECT_NEAR(distance(points[i - 1], points[i]), 0.125, 0.026) << i;
}

TEST(Breadcrumbs, KeepTheNewestPartOfTheTrack) {
  const std::deque<Point2> points = straight_track(30.0).points();
  EXPECT_LE(static_cast<double>(points.size()) * Breadcrumbs::kStepM, Breadcrumbs::kMaxLengthM);
  EXPECT_NEAR(points.back().x_m, 30.0, 0.16);
}

// The rover cuts the bend by 15 cm in reverse, as the controller may.
TEST(Breadcrumbs, TheTrackEndsWhereTheRoverHasBackedUpToBesideIt) {
  Breadcrumbs track;
  for (double angle = 0.0; angle <= 3.0; angle += 0.02) track.extend(on_arc(angle, 1.0));
  for (double angle = 3.0; angle >= 1.5; angle -= 0.02) track.retrace(on_arc(angle, 0.85));
  EXPECT_LT(distance(track.points().back(), on_arc(1.5, 1.0)), 0.2);
  EXPECT_LT(distance(track.points().front(), on_arc(0.0, 1.0)), 0.01);
}

TEST(Breadcrumbs, AStationaryRoverKeepsItsTrack) {
  Breadcrumbs track = straight_track(3.0);
  const size_t before = track.points().size();
  for (int i = 0; i < 10; ++i) track.retrace({3.0, 0.0});
  EXPECT_GE(track.points().size() + 1, before);
}

TEST(Breadcrumbs, ALoopIsLeftOut) {
  Breadcrumbs track = straight_track(3.0);
  for (double angle = 0.0; angle < 2.0 * kPi; angle += 0.02)
    track.extend({3.0 + on_arc(angle, 1.0).x_m, on_arc(angle, 1.0).y_m});
  EXPECT_LT(distance(track.points().back(), {3.0, 0.0}), 0.15);
  for (const Point2& p : track.points()) EXPECT_NEAR(p.y_m, 0.0, 0.11);
}

TEST(Breadcrumbs, WithoutATrackThereIsNone) {
  Breadcrumbs track;
  track.retrace({0.0, 0.0});
  EXPECT_TRUE(track.points().empty());
}

}  // namespace
}  // namespace rover::planning
