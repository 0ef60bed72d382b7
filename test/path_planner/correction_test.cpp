// Map moves against odom: the path follows without a step where the rover is, and ends where the goal is now.
#include <gtest/gtest.h>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::PlannerRig;

constexpr double kShiftM = 0.4;

class CorrectionTest : public testing::TestWithParam<Pose2> {
 protected:
  void SetUp() override {
    rig_.send_path({{0.0, 0.0}, {25.0, 0.0}});
    rig_.look(2);
    rig_.go(3.0);
    before_ = Route(rig_.paths.back().points);
    rig_.T_map_odom = GetParam();
    out_ = rig_.look();
  }

  Point2 goal_in_odom() const { return to_body(rig_.T_map_odom, {25.0, 0.0}); }

  PlannerRig rig_;
  Route before_;
  PlannerOutput out_;
};

TEST_P(CorrectionTest, ThePathIsSentAnewAndEndsAtTheGoal) {
  ASSERT_TRUE(out_.path);
  EXPECT_EQ(out_.path->kind, PathKind::kGlobal);
  EXPECT_NEAR(distance(out_.path->points.back().p, goal_in_odom()), 0.0, 0.02);
}

TEST_P(CorrectionTest, WhereTheRoverIsThePathDoesNotMove) {
  ASSERT_TRUE(out_.path);
  const Route after(out_.path->points);
  for (double ahead = 0.0; ahead <= 1.0; ahead += 0.05) {
    const Point2 p = before_.point_at(before_.closest(position(rig_.odom)) + ahead);
    EXPECT_LT(distance(after.point_at(after.closest(p)), p), 1e-6) << ahead;
  }
}

TEST_P(CorrectionTest, ThePathStaysInOnePieceAndBendsGently) {
  ASSERT_TRUE(out_.path);
  const Route after(out_.path->points);
  EXPECT_TRUE(after.kinks().empty());
  for (size_t i = 1; i < after.points().size(); ++i) {
    const double way = after.s_at(i) - after.s_at(i - 1);
    EXPECT_LT(way, 0.2);
    EXPECT_LT(std::abs(after.yaw_into(i) - after.yaw_out_of(i - 1)), 0.45 * std::max(way, 0.1)) << i;
  }
}

TEST_P(CorrectionTest, HazardsStayWhereTheyWereSeen) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {25.0, 0.0}});
  rig.rocks = {{{3.0, 2.0}, 0.2, 0.3}};
  rig.odom.yaw_rad = 0.5;
  rig.look(3);
  const std::vector<HazardSpot> hazards = Terrain(rig.planner.memory()).hazards();
  ASSERT_FALSE(hazards.empty());
  rig.T_map_odom = GetParam();
  rig.step();
  const std::vector<HazardSpot> now = Terrain(rig.planner.memory()).hazards();
  ASSERT_EQ(now.size(), hazards.size());
  for (size_t i = 0; i < now.size(); ++i) EXPECT_EQ(distance(now[i].p, hazards[i].p), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Shifts, CorrectionTest,
                         testing::Values(Pose2{0.0, kShiftM, 0.0}, Pose2{0.0, -kShiftM, 0.0}, Pose2{kShiftM, 0.1, 0.0},
                                         Pose2{0.0, 0.0, 0.05}, Pose2{-0.1, 0.2, -0.03}));

TEST(Correction, ASmallMovementSendsNothing) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {25.0, 0.0}});
  rig.look(2);
  rig.T_map_odom = {0.0, 0.04, 0.0};
  EXPECT_FALSE(rig.look().path);
  rig.T_map_odom = {0.0, 0.08, 0.0};
  EXPECT_TRUE(rig.look().path);
}

// What leads round the rocks is bound to them, not to the map.
TEST(Correction, ARepairStaysAndThePathAfterItMoves) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {25.0, 0.0}});
  rig.rocks = {{{3.0, 0.1}, 0.25, 0.3}};
  rig.look(2);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRepair);
  const std::vector<RoutePoint> before = rig.paths.back().points;
  rig.T_map_odom = {0.0, 0.3, 0.0};
  rig.look();
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRepair);
  const std::vector<RoutePoint>& after = rig.paths.back().points;
  size_t kept = 0;
  while (kept < std::min(after.size(), before.size()) && distance(after[kept].p, before[kept].p) < 1e-9) ++kept;
  EXPECT_GT(Route(before).s_at(kept - 1), 4.0);
  EXPECT_NEAR(after.back().p.y_m, -0.3, 0.01);
  EXPECT_GT(testing_support::clearance_along_m(rig.paths.back(), rig.rocks), 0.05);
}

}  // namespace
}  // namespace rover::planning
