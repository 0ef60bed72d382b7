// The driven track, to back up along, also when the rover backs up beside it.
#include "path_planner/breadcrumbs.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

Point2 on_arc(double angle_rad, double radius_m) {
  return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad))};
}

double length_m(const std::vector<Point2>& points) {
  double out = 0.0;
  for (size_t i = 1; i < points.size(); ++i) out += distance(points[i - 1], points[i]);
  return out;
}

Breadcrumbs straight_track(double length_m) {
  Breadcrumbs track;
  for (double x = 0.0; x <= length_m; x += 0.05) track.extend({x, 0.0});
  return track;
}

TEST(Breadcrumbs, LeadBackOverTheDrivenTrack) {
  const std::vector<Point2> back = straight_track(3.0).back(1.2);
  EXPECT_NEAR(length_m(back), 1.2, 0.11);
  EXPECT_NEAR(back.front().x_m, 3.0, 0.11);
  EXPECT_NEAR(back.back().x_m, 1.8, 0.11);
}

TEST(Breadcrumbs, KeepTheNewestPartOfTheTrack) {
  const Breadcrumbs track = straight_track(30.0);
  EXPECT_LE(static_cast<double>(track.points().size()) * Breadcrumbs::kStepM, Breadcrumbs::kMaxLengthM);
  EXPECT_NEAR(length_m(track.back(100.0)), Breadcrumbs::kMaxLengthM, 0.3);
}

// The rover cuts the bend by 15 cm in reverse, as the controller may.
TEST(Breadcrumbs, TheRestOfTheTrackLeadsFurtherBackWhenTheRoverBacksUpBesideIt) {
  Breadcrumbs track;
  for (double angle = 0.0; angle <= 3.0; angle += 0.02) track.extend(on_arc(angle, 1.0));
  Point2 rover;
  for (double angle = 3.0; angle >= 1.5; angle -= 0.02) {
    rover = on_arc(angle, 0.85);
    track.retrace(rover);
  }
  const std::vector<Point2> back = track.back(1.0);
  EXPECT_LT(length_m(back), 1.2);
  for (size_t i = 2; i < back.size(); ++i)
    EXPECT_LT(distance(back[i], on_arc(0.0, 1.0)), distance(back[i - 1], on_arc(0.0, 1.0)));
}

// In a point turn from 33 to 7 deg the rover slid by 8 cm; it never headed across.
TEST(Breadcrumbs, TheTrackDoesNotHeadWhereTheRoverSlid) {
  Breadcrumbs track;
  Point2 rover{0.0, 0.0};
  const auto go = [&](double distance_m, double heading_deg) {
    for (double s = 0.0; s < distance_m; s += 0.01) {
      rover.x_m += 0.01 * std::cos(to_rad(heading_deg));
      rover.y_m += 0.01 * std::sin(to_rad(heading_deg));
      track.extend(rover);
    }
  };
  go(1.0, 33.0);
  go(0.08, 100.0);
  go(0.4, 7.0);
  const std::vector<Point2> back = track.back(1.2);
  for (size_t i = 1; i < back.size(); ++i) {
    const double heading_deg = to_deg(std::atan2(back[i - 1].y_m - back[i].y_m, back[i - 1].x_m - back[i].x_m));
    EXPECT_GT(heading_deg, -3.0) << i;
    EXPECT_LT(heading_deg, 47.0) << i;
  }
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
  const std::vector<Point2> back = track.back(1.0);
  EXPECT_NEAR(back.front().x_m, 3.0, 0.15);
  EXPECT_NEAR(back.back().x_m, back.front().x_m - 1.0, 0.15);
  EXPECT_NEAR(back.back().y_m, 0.0, 0.05);
}

TEST(Breadcrumbs, WithoutATrackNothingLeadsBack) {
  Breadcrumbs track;
  track.retrace({0.0, 0.0});
  EXPECT_LT(track.back(1.0).size(), 2u);
}

}  // namespace
}  // namespace rover::planning
