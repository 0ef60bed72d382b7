// Keep-out and keep-in zones of the global path.
#include <gtest/gtest.h>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::planner_config;
using testing_support::PlannerRig;

Zone box(const std::string& name, Point2 low, Point2 high, bool keep_in = false) {
  return {name, keep_in, {{low.x_m, low.y_m}, {high.x_m, low.y_m}, {high.x_m, high.y_m}, {low.x_m, high.y_m}}};
}

GlobalPath path_with(const std::vector<Zone>& zones) {
  GlobalPath path{7, {{{0.0, 0.0}, kNaN, 0}, {{20.0, 0.0}, kNaN, 0}}, 0.75, 0.5};
  path.zones = zones;
  return path;
}

double depth_m(const std::vector<Zone>& zones, const Pose2& pose) {
  const Footprint footprint = planner_config().footprint;
  return forbidden_depth_m(zones, pose, footprint.half_length_m, footprint.half_width_m);
}

TEST(PlannerZones, APathThatStartsOrEndsWhereItMayNotBeIsRefusedWithTheNameOfTheZone) {
  PlannerRig rig;
  const auto refusal = [&](const Zone& zone) { return rig.planner.set_global_path(path_with({zone})); };
  EXPECT_EQ(refusal(box("landing site", {-1.0, -1.0}, {1.0, 1.0})), "path starts in keep-out 'landing site'");
  EXPECT_EQ(refusal(box("dune", {19.0, -1.0}, {21.0, 1.0})), "path ends in keep-out 'dune'");
  EXPECT_EQ(refusal(box("site", {-5.0, -5.0}, {10.0, 5.0}, true)), "path ends outside of keep-in 'site'");
  EXPECT_EQ(refusal({"line", false, {}}), "zone 'line' has fewer than 3 corners");
  EXPECT_EQ(refusal(box("dune", {8.0, -1.0}, {10.0, 1.0})), "");
}

TEST(PlannerZones, ItDrivesAroundAKeepOutAndStaysWithinAKeepIn) {
  const std::vector<Zone> zones = {box("dune", {6.0, -1.0}, {9.0, 3.0}), box("site", {-3.0, -4.5}, {23.0, 9.0}, true)};
  PlannerRig rig;
  ASSERT_EQ(rig.planner.set_global_path(path_with(zones)), "");
  rig.look();
  double farthest_m = 0.0;
  for (int i = 0; i < 400 && rig.odom.x_m < 19.0; ++i) {
    rig.go(0.2);
    ASSERT_EQ(depth_m(zones, rig.odom), 0.0) << rig.odom.x_m << " " << rig.odom.y_m;
    farthest_m = std::max(farthest_m, -rig.odom.y_m);
  }
  EXPECT_GT(rig.odom.x_m, 18.9);
  EXPECT_GT(farthest_m, 1.4) << "below the keep-out, not above it";
}

// In map: as odom drifts, zones move in odom, as the global path does.
TEST(PlannerZones, ZonesMoveWithTheMap) {
  PlannerRig rig;
  rig.T_map_odom = {2.0, -1.0, 0.3};
  const std::vector<Zone> zones = {box("dune", {7.0, -0.5}, {9.0, 0.5})};
  GlobalPath path = path_with(zones);
  const Point2 start = from_body(rig.T_map_odom, {});
  path.points = {{start, kNaN, 0}, {{20.0, 0.0}, kNaN, 0}};
  ASSERT_EQ(rig.planner.set_global_path(path), "");
  rig.look();
  for (int i = 0; i < 400 && rig.odom.x_m < 15.0; ++i) {
    rig.go(0.2);
    const Point2 p = from_body(rig.T_map_odom, position(rig.odom));
    ASSERT_EQ(depth_m(zones, {p.x_m, p.y_m, rig.odom.yaw_rad + rig.T_map_odom.yaw_rad}), 0.0) << p.x_m << " " << p.y_m;
  }
  EXPECT_GT(rig.odom.x_m, 14.9);
}

TEST(PlannerZones, ARestartKeepsThem) {
  PlannerRig rig;
  rig.planner.set_global_path(path_with({box("wall", {5.0, -30.0}, {6.0, 30.0})}));
  rig.look(3);
  PathPlanner restarted(planner_config(), 1000);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  rig.planner = restarted;
  const PlannerOutput out = rig.look(3);
  EXPECT_LT(out.status.blocked_in_m, 5.0);
}

// POSE may come later than the first tick.
TEST(PlannerZones, APathAfterARestartHasThem) {
  PlannerRig rig;
  rig.planner.set_global_path(path_with({box("dune", {8.0, -1.0}, {10.0, 1.0})}));
  rig.look(3);
  PathPlanner restarted(planner_config(), 1000);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  rig.planner = restarted;
  EXPECT_FALSE(rig.step_without_pose().path);
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->zones.size(), 1u);
}

// A correction puts the border of a zone under the left wheels: the rover may back out of it.
TEST(PlannerZones, OutOfAZoneThatACorrectionPutUnderItItBacksUp) {
  PlannerRig rig;
  rig.planner.set_start_area({0.0, 0.0}, 5.0, rig.now);
  ASSERT_EQ(rig.planner.set_global_path(path_with({box("dune", {2.5, 0.75}, {9.0, 3.0})})), "");
  rig.step();
  rig.move_to(2.5, 0.0);
  rig.T_map_odom = {0.0, 0.45, 0.0};
  rig.step();
  rig.planner.request_back_up(true);
  rig.look(2);
  EXPECT_EQ(rig.planner.mode(), Mode::kBackingUp);
}

TEST(PlannerZones, FromOneKeepInItDrivesIntoAnotherThatOverlaps) {
  const std::vector<Zone> zones = {box("west", {-3.0, -4.0}, {9.0, 4.0}, true),
                                   box("east", {7.0, -3.0}, {23.0, 5.0}, true)};
  PlannerRig rig;
  ASSERT_EQ(rig.planner.set_global_path(path_with(zones)), "");
  rig.look();
  for (int i = 0; i < 200 && rig.odom.x_m < 15.0; ++i) rig.go(0.2);
  EXPECT_GT(rig.odom.x_m, 14.9);
}

// A side may be as long as the planet.
TEST(PlannerZones, FarCornersCostNothing) {
  PlannerRig rig;
  std::vector<Zone> zones;
  for (int i = 0; i < 50; ++i)
    zones.push_back({"far " + std::to_string(i), false, {{30.0 + i, -9e5}, {9e5, -9e5}, {9e5, 9e5}, {30.0 + i, 9e5}}});
  ASSERT_EQ(rig.planner.set_global_path(path_with(zones)), "");
  rig.look(20);
  EXPECT_EQ(rig.planner.mode(), Mode::kFollowing);
}

TEST(PlannerZones, EnclosedByAZoneThereIsNoPath) {
  // Open behind the rover, but narrower than it.
  const Zone ring{"ring",
                  false,
                  {{-4, -5},
                   {7, -5},
                   {7, 5},
                   {-4, 5},
                   {-4, 0.3},
                   {-3, 0.3},
                   {-3, 4},
                   {6, 4},
                   {6, -4},
                   {-3, -4},
                   {-3, -0.3},
                   {-4, -0.3}}};
  PlannerRig rig;
  ASSERT_EQ(rig.planner.set_global_path(path_with({ring})), "");
  rig.look();
  for (int i = 0; i < 100 && rig.planner.mode() != Mode::kNoPath; ++i) {
    rig.go(1.0);
    rig.look(4);
    ASSERT_EQ(depth_m({ring}, rig.odom), 0.0);
  }
  EXPECT_EQ(rig.planner.mode(), Mode::kNoPath);
}

}  // namespace
}  // namespace rover::planning
