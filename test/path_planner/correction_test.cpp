// Map moves against odom: the path follows without a step at the rover, and ends where the goal is now.
#include <gtest/gtest.h>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::PlannerRig;

constexpr double kShiftM = 0.4;

std::vector<Point2> hazards_around(const PlannerRig& rig) {
  const Costmap costmap({}, rig.planner.belief(), position(rig.odom), 20.0);
  std::vector<Point2> out;
  for (const Hazard& hazard : costmap.hazards()) out.push_back(hazard.p);
  return out;
}

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

TEST_P(CorrectionTest, ThePathIsPublishedAgainAndEndsAtTheGoal) {
  ASSERT_TRUE(out_.path);
  EXPECT_EQ(out_.path->kind, PathKind::kGlobal);
  EXPECT_NEAR(distance(out_.path->points.back().p, goal_in_odom()), 0.0, 0.02);
}

TEST_P(CorrectionTest, ThePathDoesNotMoveAtTheRover) {
  ASSERT_TRUE(out_.path);
  const Route after(out_.path->points);
  for (double ahead = 0.0; ahead <= 1.0; ahead += 0.05) {
    const Point2 p = before_.point_at(before_.closest(position(rig_.odom)) + ahead);
    EXPECT_LT(distance(after.point_at(after.closest(p)), p), 1e-6) << ahead;
  }
}

TEST_P(CorrectionTest, ThePathHasNoGapAndBendsGently) {
  ASSERT_TRUE(out_.path);
  const Route after(out_.path->points);
  EXPECT_TRUE(after.corners().empty());
  for (size_t i = 1; i < after.points().size(); ++i) {
    const double length_m = after.s_at(i) - after.s_at(i - 1);
    EXPECT_LT(length_m, 0.2);
    EXPECT_LT(std::abs(after.yaw_into(i) - after.yaw_out_of(i - 1)), 0.45 * std::max(length_m, 0.1)) << i;
  }
}

TEST_P(CorrectionTest, HazardsStayWhereTheyWereSeen) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {25.0, 0.0}});
  rig.rocks = {{{3.0, 2.0}, 0.2, 0.3}};
  rig.odom.yaw_rad = 0.5;
  rig.look(3);
  const std::vector<Point2> before = hazards_around(rig);
  ASSERT_FALSE(before.empty());
  rig.T_map_odom = GetParam();
  rig.step();
  const std::vector<Point2> after = hazards_around(rig);
  ASSERT_EQ(after.size(), before.size());
  for (size_t i = 0; i < after.size(); ++i) EXPECT_EQ(distance(after[i], before[i]), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Shifts, CorrectionTest,
                         testing::Values(Pose2{0.0, kShiftM, 0.0}, Pose2{0.0, -kShiftM, 0.0}, Pose2{kShiftM, 0.1, 0.0},
                                         Pose2{0.0, 0.0, 0.05}, Pose2{-0.1, 0.2, -0.03}));

TEST(Correction, ASmallMovementPublishesNothing) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {25.0, 0.0}});
  rig.look(2);
  rig.T_map_odom = {0.0, 0.04, 0.0};
  EXPECT_FALSE(rig.look().path);
  rig.T_map_odom = {0.0, 0.08, 0.0};
  EXPECT_TRUE(rig.look().path);
}

TEST(Correction, APlanAroundARockStaysAndThePathBeyondItMoves) {
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
}

// Out, and back on a lane 2.5 m to the left: after a correction the rover is nearer to that lane.
TEST(Correction, ProgressStaysOnItsPartOfThePath) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {12.0, 0.0}, {12.0, 2.5}, {0.0, 2.5}});
  rig.look(2);
  rig.go(2.0);
  rig.T_map_odom = {0.0, 1.6, 0.0};
  EXPECT_NEAR(rig.step().status.corridor_offset_m, 1.6, 0.05);
}

TEST(Correction, APathToBackUpStays) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {25.0, 0.0}});
  rig.look();
  rig.go(2.0);
  rig.planner.request_back_up(true);
  rig.look(2);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kBacktrack);
  const size_t before = rig.paths.size();
  rig.T_map_odom = {0.4, 0.3, 0.02};
  EXPECT_TRUE(std::isinf(rig.look().status.blocked_in_m));
  EXPECT_EQ(rig.paths.size(), before);
}

}  // namespace
}  // namespace rover::planning
