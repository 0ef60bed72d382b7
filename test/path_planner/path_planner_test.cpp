// The planner's behaviour: what makes it publish a path, what makes it hold one back, and what it says of both.
#include "path_planner/path_planner.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::clearance_along_m;
using testing_support::PlannerRig;
using testing_support::Rock;

const std::vector<Point2> kAhead = {{0.0, 0.0}, {20.0, 0.0}};
const Rock kInTheWay{{3.0, 0.1}, 0.25, 0.3};

// A ring of rocks around the origin that nothing gets through.
std::vector<Rock> ring(double radius_m) {
  std::vector<Rock> rocks;
  for (int deg = 0; deg < 360; deg += 5)
    rocks.push_back({{radius_m * std::cos(to_rad(deg)), radius_m * std::sin(to_rad(deg))}, 0.2, 0.3});
  return rocks;
}

// The whole ring is looked at, as a rover that turns would.
void look_around(PlannerRig& rig, int frames) {
  for (int deg = -180; deg <= 180; deg += 20) {
    rig.odom.yaw_rad = to_rad(deg);
    rig.look(frames);
  }
  rig.odom.yaw_rad = 0.0;
}

TEST(PathPlanner, WithoutAGlobalPathItIsIdle) {
  PlannerRig rig;
  const PlannerOutput out = rig.look();
  EXPECT_FALSE(out.path);
  EXPECT_EQ(out.status.state, PlannerState::kIdle);
  EXPECT_EQ(out.status.path_id, -1);
  EXPECT_EQ(out.status.global_path_id, -1);
  EXPECT_EQ(out.status.text, "no global path");
}

TEST(PathPlanner, OnFreeGroundTheGlobalPathIsPublishedOnce) {
  PlannerRig rig;
  rig.send_path(kAhead);
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kGlobal);
  EXPECT_EQ(out.path->corridor_half_width_m, 0.75);
  EXPECT_EQ(out.path->goal_tolerance_m, 0.5);
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
  EXPECT_EQ(out.status.path_id, out.path->id);
  EXPECT_EQ(out.status.global_path_id, 7);
  EXPECT_NEAR(out.status.goal_distance_m, 20.0, 1e-6);
  rig.go(5.0);
  EXPECT_EQ(rig.paths.size(), 1u);
  EXPECT_NEAR(rig.look().status.goal_distance_m, 15.0, 0.1);
}

// Not seen is not safe: ahead of what the camera has seen the path is blocked by unseen ground.
TEST(PathPlanner, TheEndOfSeenGroundBlocks) {
  PlannerRig rig;
  rig.send_path(kAhead);
  const PlannerOutput out = rig.look(2);
  EXPECT_EQ(out.status.block_kind, BlockKind::kUnseen);
  EXPECT_GT(out.status.blocked_in_m, 2.0);
  EXPECT_LT(out.status.blocked_in_m, 4.0 - 0.875 + 0.15);
}

TEST(PathPlanner, ARockInTheWayIsPassedAtADistance) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kInTheWay};
  EXPECT_EQ(rig.look().status.state, PlannerState::kFollowing) << "a single frame is no hazard yet";
  const PlannerOutput out = rig.look();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kRepair);
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_EQ(out.status.replans, 1);
  EXPECT_EQ(out.status.path_id, out.path->id);
  EXPECT_GT(clearance_along_m(*out.path, rig.rocks), 0.05);
  EXPECT_NEAR(distance(out.path->points.front().p, position(rig.odom)), 0.0, 1e-6);
  EXPECT_NEAR(distance(out.path->points.back().p, kAhead.back()), 0.0, 1e-6);
  for (size_t i = 1; i < out.path->points.size(); ++i)
    EXPECT_LT(distance(out.path->points[i - 1].p, out.path->points[i].p), 0.17);
}

TEST(PathPlanner, AFurtherHazardDuringARepairIsRepairedToo) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kInTheWay};
  rig.look(2);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRepair);
  const std::int64_t first_id = rig.paths.back().id;
  // Where the repair passes the first rock, on whichever side, stands another.
  const Route repair(rig.paths.back().points);
  const Point2 aside = repair.point_at(repair.closest(kInTheWay.p));
  rig.rocks.push_back({aside, 0.2, 0.3});
  const PlannerOutput out = rig.look(3);  // the first hit is doubted, because the ground was free before
  ASSERT_NE(rig.paths.back().id, first_id);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kRepair);
  EXPECT_EQ(out.status.replans, 2);
  EXPECT_GT(rig.paths.back().id, first_id);
  EXPECT_GT(clearance_along_m(rig.paths.back(), rig.rocks), 0.05);
}

TEST(PathPlanner, PastTheRockItIsTheGlobalPathAgain) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kInTheWay};
  rig.look(2);
  const PlannerOutput out = rig.go(10.0);
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kGlobal);
  EXPECT_EQ(rig.paths.back().corridor_half_width_m, 0.75);
  EXPECT_LT(out.status.corridor_offset_m, 0.05);
}

TEST(PathPlanner, HazardsFarBehindAreForgotten) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {30.0, 0.0}});
  rig.rocks = {kInTheWay};
  rig.look(2);
  EXPECT_FALSE(Terrain(rig.planner.memory()).hazards().empty());
  rig.go(14.0);
  EXPECT_TRUE(Terrain(rig.planner.memory()).hazards().empty());
}

// The original forgot what left the view to the side, and turned into it.
TEST(PathPlanner, AHazardBesideTheRoverBlocksAPointTurn) {
  PlannerRig rig;
  rig.odom = {-1.5, -0.3, 0.0};
  rig.send_path({{-1.5, -0.3}, {10.0, -0.3}});
  rig.rocks = {{{0.0, 0.45}, 0.12, 0.3}};
  rig.look(2);
  rig.go(1.5);
  ASSERT_LT(std::abs(rig.odom.x_m), 0.3);
  rig.rocks.clear();  // out of view: only the memory knows it
  rig.send_path({position(rig.odom), {rig.odom.x_m, 10.0}}, 8);
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.status.block_kind, BlockKind::kHazard);
  EXPECT_NEAR(out.status.blocked_in_m, 0.0, 1e-9);
}

TEST(PathPlanner, APointTurnOnFreeGroundIsNotBlocked) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {0.0, 10.0}});
  const PlannerOutput out = rig.look(2);
  EXPECT_GT(out.status.blocked_in_m, 0.5);
}

TEST(PathPlanner, WithoutAFreshPoseThereIsNoPath) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look(2);
  rig.now += 400'000;
  EXPECT_EQ(rig.step_without_pose().status.state, PlannerState::kFollowing);
  rig.now += 200'000;
  const PlannerOutput out = rig.step_without_pose();
  EXPECT_FALSE(out.path);
  EXPECT_EQ(out.status.state, PlannerState::kIdle);
  EXPECT_EQ(out.status.path_id, -1);
  EXPECT_EQ(out.status.text, "no fresh pose");
  EXPECT_EQ(out.status.blocked_in_m, 0.0);
  EXPECT_EQ(rig.step().status.state, PlannerState::kFollowing);
}

TEST(PathPlanner, APathThatComesWithoutAPoseWaitsForOne) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.now = 100'000;
  EXPECT_FALSE(rig.step_without_pose().path);
  EXPECT_TRUE(rig.step().path);
}

TEST(PathPlanner, APoseThatIsNotUsableEndsWhatIsKnownOfThePose) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look(2);
  PoseSample lost = rig.sample();
  lost.utime += 100'000;
  lost.usable = false;
  rig.planner.add_pose(lost);
  rig.now = lost.utime;
  EXPECT_EQ(rig.step_without_pose().status.path_id, -1);
}

TEST(PathPlanner, AFrameIsLaidWhereThePoseOfItsExposureIsKnown) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look(2);
  EXPECT_TRUE(rig.planner.add_hazards(observe(rig.camera, {}, rig.odom, rig.now - 50'000, rig.random)));
  EXPECT_FALSE(rig.planner.add_hazards(observe(rig.camera, {}, rig.odom, rig.now + 50'000, rig.random)));
  EXPECT_FALSE(rig.planner.add_hazards(observe(rig.camera, {}, rig.odom, rig.now - 60'000'000, rig.random)));
  HazardGrid broken = observe(rig.camera, {}, rig.odom, rig.now, rig.random);
  broken.cells.pop_back();
  EXPECT_FALSE(rig.planner.add_hazards(broken));
}

TEST(PathPlanner, WhatIsNoPathIsRefusedWithAReasonAndTheOldOneStays) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look(2);
  const std::vector<std::vector<Point2>> bad = {
      {}, {{1, 1}}, {{0, 0}, {kNaN, 0}}, {{0, 0}, {5, kInfinity}}, {{1, 1}, {1, 1}, {1, 1}}, {{0, 0}, {2e5, 0}}};
  for (const auto& points : bad) EXPECT_NE(rig.send_path(points, 9), "") << points.size();
  for (const auto& [corridor, tolerance] : {std::pair{-1.0, 0.5}, {kInfinity, 0.5}, {0.5, -1.0}, {0.5, kInfinity}})
    EXPECT_NE(rig.planner.set_global_path({9, {{{0, 0}}, {{5, 0}}}, corridor, tolerance}), "");
  const PlannerOutput out = rig.look();
  EXPECT_EQ(out.status.global_path_id, 7);
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
}

TEST(PathPlanner, APathThatNamesNoCorridorGetsTheConfigurations) {
  PlannerRig rig;
  EXPECT_EQ(rig.planner.set_global_path({9, {{{0, 0}}, {{5, 0}}}, kNaN, kNaN}), "");
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->corridor_half_width_m, testing_support::planner_config().corridor_half_width_m);
  EXPECT_EQ(out.path->goal_tolerance_m, testing_support::planner_config().goal_tolerance_m);
}

TEST(PathPlanner, FarFromThePathAWayToItIsPlanned) {
  PlannerRig rig;
  rig.odom = {0.0, -1.2, 0.0};
  rig.send_path(kAhead);
  const PlannerOutput out = rig.look(2);
  ASSERT_FALSE(rig.paths.empty());
  EXPECT_EQ(rig.paths.back().kind, PathKind::kRepair);
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_NEAR(distance(rig.paths.back().points.front().p, position(rig.odom)), 0.0, 0.01);
  EXPECT_EQ(out.status.replans, 0) << "no hazard was the reason";
}

TEST(PathPlanner, EnclosedByRocksItSaysThatThereIsNoWay) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = ring(1.7);
  look_around(rig, 2);
  const PlannerOutput out = rig.look(10);
  EXPECT_EQ(out.status.state, PlannerState::kNoPath);
  EXPECT_EQ(out.status.block_kind, BlockKind::kHazard);
  EXPECT_LT(out.status.blocked_in_m, 0.6);
  EXPECT_EQ(out.status.text, "hazards block every path to the global path");
  const size_t before = rig.paths.size();
  rig.look(10);
  EXPECT_EQ(rig.paths.size(), before) << "no path through rocks";
}

// As EnclosedByRocks above, with a share of work that allows one search a frame.
TEST(PathPlanner, ASearchThatTakesMoreThanAFramesShareGoesOnAtTheNext) {
  PathPlannerConfig config = testing_support::planner_config();
  config.frame_work = 1;
  PlannerRig rig(config);
  rig.send_path(kAhead);
  rig.rocks = ring(1.7);
  look_around(rig, 1);
  const PlannerOutput out = rig.look(20);
  EXPECT_EQ(out.status.state, PlannerState::kNoPath);
  EXPECT_EQ(out.status.text, "hazards block every path to the global path");
}

// A rover that knows no ground but that under it: it stands, waits some frames, finds no way and says so.
TEST(PathPlanner, StandingBeforeUnseenGroundItSaysThatThereIsNoWay) {
  PlannerRig rig;
  rig.planner.set_start_area({0.0, 0.0}, 0.0, 0);
  rig.send_path(kAhead);
  rig.camera.far_m = 0.0;  // dust, night, a cap on the lens
  PlannerOutput out = rig.look();
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
  EXPECT_EQ(out.status.block_kind, BlockKind::kUnseen);
  EXPECT_LT(out.status.blocked_in_m, 0.35);
  const size_t before = rig.paths.size();
  out = rig.look(12);
  EXPECT_EQ(out.status.state, PlannerState::kNoPath);
  EXPECT_EQ(out.status.text, "unseen ground blocks every path to the global path");
  EXPECT_EQ(out.status.replans, 0);
  EXPECT_EQ(rig.paths.size(), before);
  rig.planner.set_start_area({0.0, 0.0}, 2.0, rig.now);
  EXPECT_EQ(rig.step().status.state, PlannerState::kFollowing);
}

// No way leads on and there is no room to turn, but one way led here.
TEST(PathPlanner, WhereNoWayLeadsOnItGoesBackOverItsTrack) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.camera.far_m = 0.0;
  for (rig.odom.x_m = 0.0; rig.odom.x_m < 1.0; rig.odom.x_m += 0.05) rig.step();
  rig.look(20);
  const auto retreat =
      std::find_if(rig.paths.begin(), rig.paths.end(), [](const LocalPath& p) { return p.kind == PathKind::kRetreat; });
  ASSERT_NE(retreat, rig.paths.end());
  EXPECT_NEAR(distance(retreat->points.front().p, position(rig.odom)), 0.0, 0.01);
  for (const RoutePoint& point : retreat->points) {
    EXPECT_NEAR(point.p.y_m, 0.0, 1e-9);
    EXPECT_GE(point.p.x_m, -1e-9);
    EXPECT_LE(point.p.x_m, rig.odom.x_m + 1e-9);
  }
  EXPECT_LT(retreat->points.back().p.x_m, rig.odom.x_m - 0.4);
}

// The rover had turned and come back on its own track, so the retreat's end lies on its beginning.
TEST(PathPlanner, ARetreatThatLeadsToAndFroEndsWhereItEnds) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.camera.far_m = 0.0;
  for (rig.odom.x_m = 0.0; rig.odom.x_m < 2.0; rig.odom.x_m += 0.05) rig.step();
  rig.odom.yaw_rad = kPi;
  for (; rig.odom.x_m > 1.2; rig.odom.x_m -= 0.05) rig.step();
  rig.look(20);
  const LocalPath retreat = rig.paths.back();
  ASSERT_EQ(retreat.kind, PathKind::kRetreat);
  ASSERT_GT(retreat.points.back().p.x_m, 1.2 + 0.1);
  rig.forward_mps = -0.1;
  for (const RoutePoint& point : retreat.points) {
    rig.odom = {point.p.x_m, point.p.y_m, kPi};
    rig.look();
    ASSERT_EQ(rig.paths.back().id, retreat.id);
  }
  rig.forward_mps = 0.0;
  rig.look(20);
  EXPECT_NE(rig.paths.back().id, retreat.id);
}

TEST(PathPlanner, AGoalUnderARockIsReachedBesideIt) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {6.0, 0.0}});
  const Rock on_goal{{6.0, 0.0}, 0.25, 0.4};
  rig.rocks = {on_goal};
  rig.look(3);
  PlannerOutput out;
  for (int leg = 0; leg < 40 && !(out.status.goal_distance_m < 0.1); ++leg) {
    rig.go(0.5);
    out = rig.look(6);
  }
  EXPECT_LT(out.status.goal_distance_m, 0.1);
  EXPECT_EQ(out.status.text, "the goal is blocked: the path ends beside it");
  EXPECT_LT(distance(position(rig.odom), on_goal.p), 1.3);
  EXPECT_GT(clearance_m(testing_support::planner_config().footprint, rig.odom, rig.rocks), 0.0);
}

// On a slope: a rock beside the track, towards which the rover slides as it backs.
TEST(PathPlanner, ARetreatThatSlidesTowardsARockIsStopped) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {{{2.0, 0.85}, 0.2, 0.3}};
  rig.look(3);
  rig.go(3.0);
  rig.planner.want_retreat(true);
  rig.look();
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  const std::int64_t retreat = rig.paths.back().id;
  rig.forward_mps = -0.1;
  rig.odom.x_m -= 0.2;
  EXPECT_TRUE(std::isinf(rig.look().status.blocked_in_m));
  rig.odom.y_m += 0.16;
  EXPECT_LT(rig.look().status.blocked_in_m, 0.2);
  rig.forward_mps = 0.0;
  rig.look(testing_support::planner_config().patience_frames + 1);
  EXPECT_NE(rig.paths.back().id, retreat);
}

// FDIR has stopped the rover on the retreat: it must not wait there for ever.
TEST(PathPlanner, ARetreatThatTheRoverIsNotLetGoOnIsReplaced) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.camera.far_m = 0.0;
  for (rig.odom.x_m = 0.0; rig.odom.x_m < 1.5; rig.odom.x_m += 0.05) rig.step();
  rig.look(20);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  const std::int64_t retreat = rig.paths.back().id;
  rig.look(20);
  ASSERT_EQ(rig.paths.back().id, retreat);  // undisturbed it is kept
  rig.planner.request_replan();
  rig.look(20);
  EXPECT_NE(rig.paths.back().id, retreat);
}

// Nothing is seen from where the rover stands. From elsewhere it may be, but not from ever further back.
TEST(PathPlanner, OnDemandItGoesBackOverItsTrackAndNotForEver) {
  PlannerRig rig;
  rig.send_path(kAhead);
  for (rig.odom.x_m = 0.0; rig.odom.x_m < 5.0; rig.odom.x_m += 0.05) rig.look();
  ASSERT_EQ(rig.paths.size(), 1u);
  rig.planner.want_retreat(true);
  rig.forward_mps = 0.1;
  rig.look(3);
  ASSERT_EQ(rig.paths.size(), 1u) << "still rolling";
  rig.forward_mps = 0.0;
  rig.planner.want_retreat(false);
  rig.look(3);
  ASSERT_EQ(rig.paths.size(), 1u) << "the fault is over";
  int retreats = 0;
  for (int i = 0; i < 4; ++i) {
    const size_t before = rig.paths.size();
    rig.planner.want_retreat(true);
    rig.look();
    if (rig.paths.size() == before) continue;
    ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
    ++retreats;
    const Point2 end = rig.paths.back().points.back().p;
    EXPECT_NEAR(rig.odom.x_m - end.x_m, 1.2 * retreats, 0.1);
    rig.odom = {end.x_m, end.y_m, 0.0};
    rig.look(3);
    ASSERT_EQ(rig.paths.back().kind, PathKind::kRepair) << "from there it goes on";
  }
  EXPECT_EQ(retreats, 2);
}

TEST(PathPlanner, OnDemandAClearPathIsReplacedTooAndOnce) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look(3);
  const size_t before = rig.paths.size();
  rig.look(20);
  ASSERT_EQ(rig.paths.size(), before);
  rig.planner.request_replan();
  rig.look(20);
  EXPECT_EQ(rig.paths.size(), before + 1);
}

TEST(PathPlanner, AStartAreaBeginsAnew) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kInTheWay};
  rig.look(3);
  rig.planner.set_start_area({0.0, 0.0}, 2.0, rig.now);
  rig.rocks.clear();
  const PlannerOutput out = rig.step();
  EXPECT_TRUE(Terrain(rig.planner.memory()).hazards().empty());
  EXPECT_FALSE(Terrain(rig.planner.memory()).unseen(Point2{1.9, 0.0}));
  EXPECT_TRUE(Terrain(rig.planner.memory()).unseen(Point2{2.3, 0.0}));
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kGlobal);
}

TEST(PathPlanner, TheSameInputsGiveTheSameBytes) {
  PlannerRig a;
  PlannerRig b;
  for (PlannerRig* rig : {&a, &b}) {
    rig->send_path({{0.0, 0.0}, {8.0, 1.0}, {20.0, 0.0}});
    rig->camera.false_hit_rate = 0.5;
    rig->rocks = {kInTheWay, {{6.0, 1.2}, 0.3, 0.3}};
    rig->look(2);
    rig->go(6.0);
  }
  EXPECT_EQ(a.planner.save(), b.planner.save());
  ASSERT_EQ(a.paths.size(), b.paths.size());
  EXPECT_GE(a.paths.size(), 3u);
  for (size_t i = 0; i < a.paths.size(); ++i) {
    ASSERT_EQ(a.paths[i].points.size(), b.paths[i].points.size());
    for (size_t k = 0; k < a.paths[i].points.size(); ++k) {
      EXPECT_EQ(a.paths[i].points[k].p.x_m, b.paths[i].points[k].p.x_m);
      EXPECT_EQ(a.paths[i].points[k].p.y_m, b.paths[i].points[k].p.y_m);
    }
  }
}

}  // namespace
}  // namespace rover::planning
