// Local repairs on ground of known shape.
#include <gtest/gtest.h>

#include "test/path_planner/repair_field.hpp"

namespace rover::planning {
namespace {

using testing_support::ground;
using testing_support::lay_rocks;
using testing_support::plan_on;
using testing_support::planner_config;
using testing_support::RepairField;
using testing_support::Rock;
using testing_support::straight_route;

const Rock kInTheWay{{2.6, 0.0}, 0.2, 0.3};

RepairField field_with(const std::vector<Rock>& rocks, double length_ahead_m = 20.0) {
  RepairField field{ground(true), straight_route(length_ahead_m), 4.0, {}, 0.0, {}, kInfinity};
  lay_rocks(field.memory, rocks);
  return field;
}

RepairResult plan(const RepairField& field, const LocalRepairConfig& config = planner_config().repair) {
  return plan_on(field, Terrain(field.memory), config);
}

std::vector<Rock> row(Point2 from, Point2 to) {
  std::vector<Rock> rocks;
  const int count = static_cast<int>(std::ceil(distance(from, to) / 0.2));
  for (int i = 0; i <= count; ++i) {
    const double u = static_cast<double>(i) / std::max(count, 1);
    rocks.push_back({{from.x_m + u * (to.x_m - from.x_m), from.y_m + u * (to.y_m - from.y_m)}, 0.15, 0.3});
  }
  return rocks;
}

std::vector<Rock> box(double half_m) {
  std::vector<Rock> rocks;
  for (const auto& [a, b] : {std::pair{Point2{-half_m, -half_m}, Point2{half_m, -half_m}},
                             std::pair{Point2{half_m, -half_m}, Point2{half_m, half_m}},
                             std::pair{Point2{half_m, half_m}, Point2{-half_m, half_m}},
                             std::pair{Point2{-half_m, half_m}, Point2{-half_m, -half_m}}})
    for (const Rock& rock : row(a, b)) rocks.push_back(rock);
  return rocks;
}

TEST(LocalRepair, LeadsRoundARockAndBackToThePath) {
  const RepairResult result = plan(field_with({kInTheWay}));
  ASSERT_EQ(result.status, RepairStatus::kFound);
  EXPECT_FALSE(result.turns_first);
  EXPECT_EQ(result.halts, 0);
  EXPECT_TRUE(result.smoothed);
  EXPECT_GT(result.clearance_m, testing_support::kRepairMarginM - 1e-9);
  EXPECT_GT(result.join_m - 4.0, 3.0);
}

// The original crashed here.
TEST(LocalRepair, EnclosedByHazardsThereIsNoWayAndNoPath) {
  for (const double half_m : {1.3, 1.8, 2.5}) {
    const RepairResult result = plan(field_with(box(half_m)));
    EXPECT_EQ(result.status, RepairStatus::kNoWay) << half_m;
    EXPECT_TRUE(result.poses.empty());
    EXPECT_STREQ(text_of(result.status), "hazards block every path to the global path");
  }
}

TEST(LocalRepair, StandingAmongHazardsThatTouchItThereIsNoWay) {
  const RepairResult result = plan(field_with(box(0.7)));
  EXPECT_EQ(result.status, RepairStatus::kNoWay);
  EXPECT_TRUE(result.poses.empty());
}

TEST(LocalRepair, WhereTheWholePathIsBlockedThereIsNoTarget) {
  const RepairResult result = plan(field_with(row({1.8, 0.0}, {4.9, 0.0})));
  EXPECT_EQ(result.status, RepairStatus::kNoTarget);
  EXPECT_TRUE(result.poses.empty());
}

TEST(LocalRepair, WhereNothingWasSeenAheadNothingIsPromised) {
  RepairField field = field_with({});
  field.memory = ground(false);
  field.memory.mark_driven(field.start, planner_config().footprint);
  const RepairResult result = plan(field);
  EXPECT_EQ(result.status, RepairStatus::kUnseen);
  EXPECT_TRUE(result.poses.empty());
}

TEST(LocalRepair, AsSoonAsPossibleJoinsBeforeWithinADistance) {
  LocalRepairConfig soon = planner_config().repair;
  soon.rejoin_within_m = 0.0;
  soon.max_deviation_m = 4.5;
  LocalRepairConfig within = soon;
  within.rejoin_within_m = 4.0;
  const RepairField field = field_with({{{0.9, -0.9}, 0.1, 0.3}, {{1.5, 0.0}, 0.1, 0.3}});
  const RepairResult first = plan(field, soon);
  const RepairResult later = plan(field, within);
  ASSERT_EQ(first.status, RepairStatus::kFound);
  ASSERT_EQ(later.status, RepairStatus::kFound);
  EXPECT_LE(first.join_m, later.join_m);
  // The path is clear from where the rectangle's back has passed the rock.
  const double clear_m = 4.0 + 1.5 + 0.1 + 0.875 + testing_support::kRepairMarginM;
  EXPECT_LE(first.join_m, clear_m + 1.0 + 0.1);
  EXPECT_LE(later.join_m, clear_m + 4.0 + 0.1);
}

TEST(LocalRepair, NearTheGoalItEndsAtTheGoal) {
  const RepairResult result = plan(field_with({{{1.7, 0.0}, 0.15, 0.3}}, 3.3));
  ASSERT_EQ(result.status, RepairStatus::kFound);
  EXPECT_LE(distance(position(result.poses.back()), {3.3, 0.0}), testing_support::kRepairGoalReachM);
}

// A boulder where the goal was drawn: without reach there is no way, with it the rover stops clear of the boulder.
TEST(LocalRepair, AGoalUnderARockIsReachedBesideIt) {
  const Rock on_goal{{3.3, 0.0}, 0.25, 0.4};
  const RepairField field = field_with({on_goal}, 3.3);
  const Terrain terrain(field.memory);
  EXPECT_NE(plan_on(field, terrain, planner_config().repair).status, RepairStatus::kFound);
  const RepairResult result = plan_on(field, terrain, planner_config().repair, 1.2);
  ASSERT_EQ(result.status, RepairStatus::kFound);
  EXPECT_LE(distance(position(result.poses.back()), on_goal.p), 1.2 + 1e-9);
  EXPECT_GT(result.clearance_m, testing_support::kRepairMarginM - 1e-9);
}

// A wall too near to be passed on an arc: the rover turns on the spot first.
TEST(LocalRepair, BeforeAWallItTurnsOnTheSpot) {
  const RepairField field = field_with(row({1.45, -3.0}, {1.45, 1.2}));
  const RepairResult result = plan(field);
  ASSERT_EQ(result.status, RepairStatus::kFound);
  EXPECT_TRUE(result.turns_first || result.halts > 0);
}

// A rock at a front corner, clear of the rectangle as it stands, is in the way of the turn to its side.
TEST(LocalRepair, ItTurnsToTheSideOnWhichTheCornersSweepFreely) {
  const Footprint footprint = planner_config().footprint;
  for (const double side : {1.0, -1.0}) {
    std::vector<Rock> rocks = row({1.45, -1.7 * side}, {1.45, 0.9 * side});  // the shorter way would be on this side
    rocks.push_back({{0.85, 0.72 * side}, 0.08, 0.3});
    const RepairField field = field_with(rocks);
    const Terrain terrain(field.memory);
    const RepairResult result = plan(field);
    ASSERT_EQ(result.status, RepairStatus::kFound);
    ASSERT_TRUE(result.turns_first);
    const double turn = result.poses.front().yaw_rad;
    EXPECT_LT(side * turn, 0.0);
    for (int k = 0; k <= 50; ++k)
      for (const HazardSpot& hazard : terrain.hazards())
        ASSERT_GE(footprint.distance_m({0.0, 0.0, turn * k / 50.0}, hazard.p), testing_support::kRepairMarginM - 0.005);
  }
}

TEST(LocalRepair, ARockOfASingleHitIsPassedToo) {
  RepairField field = field_with({});
  field.memory.map().at(field.memory.map().index_of(1.95, 0.05)).hits = 1;
  const RepairResult result = plan(field);
  ASSERT_EQ(result.status, RepairStatus::kFound);
  const Footprint footprint = planner_config().footprint;
  for (const Pose2& pose : result.poses)
    EXPECT_GE(footprint.distance_m(pose, {1.95, 0.05}), testing_support::kRepairMarginM - 1e-9);
}

// The mirror image of a field has the mirror image of its repair, within what the order of ties may change.
TEST(LocalRepair, PassesOnTheSideThatHasMoreRoom) {
  for (const double side : {1.0, -1.0}) {
    std::vector<Rock> rocks = row({1.9, 0.15 * side}, {1.9, 3.0 * side});
    const RepairResult result = plan(field_with(rocks));
    ASSERT_EQ(result.status, RepairStatus::kFound);
    for (const Pose2& pose : result.poses) EXPECT_LT(side * pose.y_m, 0.3);
  }
}

TEST(Terrain, TheDistanceBetweenCellCentresIsBilinearWithItsGradient) {
  const RepairField field = field_with({{{1.0, 1.0}, 0.2, 0.3}, {{-2.0, 0.5}, 0.3, 0.3}});
  const Terrain terrain(field.memory);
  std::mt19937_64 random(1);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Point2 p{testing_support::uniform(random, -4.0, 4.0), testing_support::uniform(random, -4.0, 4.0)};
    Eigen::Vector2d gradient;
    Eigen::Vector2d unused;
    const double d = terrain.hazard_distance_smooth(p, gradient);
    if (d > 4.5) continue;  // saturates far from hazards
    ASSERT_NEAR(d, terrain.hazard_distance_m(p), 0.1);
    const double gx = (terrain.hazard_distance_smooth({p.x_m + kStep, p.y_m}, unused) - d) / kStep;
    const double gy = (terrain.hazard_distance_smooth({p.x_m, p.y_m + kStep}, unused) - d) / kStep;
    ASSERT_NEAR(gradient.x(), gx, 1e-4);
    ASSERT_NEAR(gradient.y(), gy, 1e-4);
  }
}

TEST(FootprintCheck, WhoStandsNearAHazardMayLeaveItButNotComeCloser) {
  RepairField field = field_with({});
  field.memory.map().at(field.memory.map().index_of(0.95, 0.05)).hits = 2;  // 0.075 m ahead of the rectangle
  const Terrain terrain(field.memory);
  const FootprintCheck check(terrain, planner_config().footprint, 0.17, 0.0, field.start);
  EXPECT_TRUE(check.clear({0.0, 0.0, 0.0}));
  EXPECT_TRUE(check.clear({-0.2, 0.0, 0.0}));
  EXPECT_FALSE(check.clear({0.05, 0.0, 0.0}));
  EXPECT_FALSE(check.clear({0.2, 0.0, 0.0}));
}

}  // namespace
}  // namespace rover::planning
