// The way back, when the rover goes back beside it.
#include "path_planner/driven_track.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

Point2 on_arc(double way_m, double radius_m) {
  return {radius_m * std::sin(way_m), radius_m * (1.0 - std::cos(way_m))};
}

double length_m(const std::vector<Point2>& points) {
  double out = 0.0;
  for (size_t i = 1; i < points.size(); ++i) out += distance(points[i - 1], points[i]);
  return out;
}

TEST(DrivenTrack, GoesBackOverWhatWasDriven) {
  DrivenTrack track;
  for (double x = 0.0; x <= 3.0; x += 0.05) track.extend({x, 0.0});
  const std::vector<Point2> back = track.back({3.0, 0.0}, 1.2);
  EXPECT_NEAR(length_m(back), 1.2, 0.11);
  EXPECT_NEAR(back.back().x_m, 1.8, 0.11);
}

// The rover cuts the bend by 15 cm on its way back, as the controller may; the rest of the way must still lead back.
TEST(DrivenTrack, RetracedBesideTheTrackTheRestLeadsFurtherBack) {
  DrivenTrack track;
  for (double way = 0.0; way <= 3.0; way += 0.02) track.extend(on_arc(way, 1.0));
  Point2 rover;
  for (double way = 3.0; way >= 1.5; way -= 0.02) {
    rover = on_arc(way, 0.85);
    track.retrace(rover);
  }
  const std::vector<Point2> back = track.back(rover, 1.0);
  EXPECT_LT(length_m(back), 1.2);
  for (size_t i = 2; i < back.size(); ++i)
    EXPECT_LT(distance(back[i], on_arc(0.0, 1.0)), distance(back[i - 1], on_arc(0.0, 1.0)));
}

TEST(DrivenTrack, StandingItStays) {
  DrivenTrack track;
  for (double x = 0.0; x <= 3.0; x += 0.05) track.extend({x, 0.0});
  const size_t before = track.points().size();
  for (int i = 0; i < 10; ++i) track.retrace({3.0, 0.0});
  EXPECT_GE(track.points().size() + 1, before);
}

TEST(DrivenTrack, WithoutATrackThereIsNoWayBack) {
  DrivenTrack track;
  track.retrace({0.0, 0.0});
  EXPECT_LT(track.back({0.0, 0.0}, 1.0).size(), 2u);
}

}  // namespace
}  // namespace rover::planning
