// The Full level: maps of the NavCam make continuous paths, and plans may reverse.
#include <gtest/gtest.h>

#include <functional>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::planner_config;
using testing_support::PlannerRig;

constexpr double kMapSideM = 20.0;
using CostAt = std::function<std::uint8_t(Point2)>;

// A map around the point.
TraversabilityGrid map_around(Point2 center, const CostAt& cost, Utime utime) {
  const int cells = static_cast<int>(kMapSideM / 0.1);
  TraversabilityGrid map{{utime, 0.1, center.x_m - 0.5 * kMapSideM, center.y_m - 0.5 * kMapSideM, cells, cells, {}}};
  for (int iy = 0; iy < cells; ++iy)
    for (int ix = 0; ix < cells; ++ix)
      map.cells.push_back(cost({map.origin_x_m + (ix + 0.5) * 0.1, map.origin_y_m + (iy + 0.5) * 0.1}));
  testing_support::complete(map);
  return map;
}

std::uint8_t impassable_if(bool impassable) {
  return impassable ? TraversabilityGrid::kImpassable : std::uint8_t{0};
}

std::uint8_t free_map(Point2 /*p*/) {
  return 0;
}

// A wall across the path at x = 4 with a gap.
CostAt wall_map(double middle_m, double width_m) {
  return [=](Point2 p) {
    return impassable_if(std::abs(p.x_m - 4.0) < 0.15 && std::abs(p.y_m - middle_m) >= 0.5 * width_m);
  };
}

// The end of a channel that is too narrow to turn in, 2.5 m from its mouth.
std::uint8_t channel_map(Point2 p) {
  const bool sides = std::abs(std::abs(p.y_m) - 0.85) < 0.1 && p.x_m > -2.5 && p.x_m < 1.4;
  const bool end = std::abs(p.x_m - 1.3) < 0.1 && std::abs(p.y_m) < 0.95;
  return impassable_if(sides || end);
}

class FullLevelTest : public testing::Test {
 protected:
  void SetUp() override {
    rig_.send_path({{0.0, 0.0}, {30.0, 0.0}});
    rig_.step();
    rig_.planner.set_level(true);
  }
  bool send_map(const CostAt& cost) {
    return rig_.planner.add_traversability(map_around(position(rig_.odom), cost, rig_.now));
  }
  const LocalPath& path() const { return rig_.paths.back(); }
  PlannerRig rig_;
};

TEST_F(FullLevelTest, AMapMakesAContinuousPath) {
  ASSERT_TRUE(send_map(wall_map(1.2, 1.8)));
  const PlannerOutput out = rig_.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kContinuous);
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
  EXPECT_EQ(out.status.replans, 0);
  EXPECT_GT(out.status.blocked_in_m, 5.0);
  EXPECT_NEAR(out.path->points.back().p.x_m, 30.0, 1e-6);
  const Route route(out.path->points);
  EXPECT_NEAR(route.point_at(route.closest({4.0, 1.2})).y_m, 1.2, 0.4);
  EXPECT_TRUE(route.corners().empty());
}

TEST_F(FullLevelTest, AtTheEfficientLevelMapsChangeNothing) {
  rig_.planner.set_level(false);
  EXPECT_FALSE(send_map(wall_map(1.2, 1.8)));
  EXPECT_FALSE(rig_.step().path);
  EXPECT_EQ(rig_.paths.size(), 1u);
}

TEST_F(FullLevelTest, AnUnusableMapIsRefused) {
  TraversabilityGrid map = map_around({0.0, 0.0}, free_map, rig_.now);
  map.cells.pop_back();
  EXPECT_FALSE(rig_.planner.add_traversability(map));
  EXPECT_FALSE(rig_.step().path);
}

TEST_F(FullLevelTest, BackAtTheEfficientLevelItReturnsToTheGlobalPath) {
  send_map(wall_map(1.2, 1.8));
  rig_.step();
  rig_.planner.set_level(false);
  rig_.go(22.0);
  EXPECT_GT(rig_.odom.x_m, 18.0);
  EXPECT_NEAR(rig_.odom.y_m, 0.0, 0.1);
}

TEST_F(FullLevelTest, BackAtTheEfficientLevelTheGlobalPathHasItsOwnCorridor) {
  send_map(wall_map(1.2, 1.8));
  rig_.step();
  ASSERT_LT(path().corridor_half_width_m, 0.75);
  rig_.planner.set_level(false);
  rig_.go(22.0);
  EXPECT_EQ(path().kind, PathKind::kGlobal);
  EXPECT_EQ(path().corridor_half_width_m, 0.75);
}

TEST_F(FullLevelTest, ARestartKeepsHeights) {
  TraversabilityGrid map = map_around({0.0, 0.0}, free_map, rig_.now);
  map.height_m.assign(map.cells.size(), 0.3F);
  ASSERT_TRUE(rig_.planner.add_traversability(map));
  PathPlanner restarted(planner_config(), 1000);
  ASSERT_TRUE(restarted.restore(rig_.planner.save()));
  EXPECT_EQ(restarted.belief().cells().get({20, 20}).height_m, 0.3F);
}

TEST_F(FullLevelTest, TheSameMapAgainKeepsThePath) {
  send_map(wall_map(1.2, 1.8));
  rig_.step();
  const size_t before = rig_.paths.size();
  for (int i = 0; i < 4; ++i) {
    rig_.go(0.4);
    send_map(wall_map(1.2, 1.8));
    rig_.step();
  }
  EXPECT_LE(rig_.paths.size(), before + 1);
}

TEST_F(FullLevelTest, APlanThatReversesIsOnePath) {
  send_map(channel_map);
  const PlannerOutput out = rig_.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kContinuous);
  EXPECT_GT(out.status.goal_distance_m, 25.0);
  const Route route(out.path->points);
  const PathSegment back = route.segment_at(0.0);
  ASSERT_TRUE(back.reverse);
  EXPECT_LT(route.point_at(back.end_m).x_m, -2.0);
  EXPECT_NEAR(out.path->points.back().p.x_m, 30.0, 1e-6);
  // Driven over the cusp the path stays, and the rover's place on it is never taken for one on the other segment.
  double before_m = 0.0;
  for (double s = 0.0; s <= back.end_m + 1.0; s += 0.05) {
    rig_.odom = route.pose_at(s);
    rig_.forward_mps = route.segment_at(s).reverse ? -0.2 : 0.2;
    if (std::abs(s - back.end_m) < 0.1) rig_.forward_mps = 0.0;
    EXPECT_FALSE(rig_.look().path) << s;
    const double at_m = rig_.planner.active_path().progress_m();
    EXPECT_NEAR(at_m, s, 0.15);
    EXPECT_GE(at_m, before_m - 0.05);
    before_m = at_m;
  }
}

// What lies behind a cusp is over: a controller that takes the path anew shall not drive it again.
TEST_F(FullLevelTest, PastACuspAPathBeginsThere) {
  send_map(channel_map);
  rig_.step();
  const Route route(path().points);
  const PathSegment back = route.segment_at(0.0);
  ASSERT_TRUE(back.reverse);
  rig_.odom = route.pose_at(back.end_m);
  rig_.look(2);
  rig_.T_map_odom = {0.0, 0.3, 0.0};
  const PlannerOutput out = rig_.step();
  ASSERT_TRUE(out.path) << "the correction moves its end";
  EXPECT_FALSE(out.path->points.front().reverse);
  EXPECT_LT(distance(out.path->points.front().p, position(rig_.odom)), 0.05);
}

TEST_F(FullLevelTest, RestartedWhileItReversesItKeepsThePath) {
  send_map(channel_map);
  rig_.step();
  const size_t points = path().points.size();
  constexpr std::int64_t kFirstId = 1'000'001;
  PathPlanner restarted(planner_config(), kFirstId);
  ASSERT_TRUE(restarted.restore(rig_.planner.save()));
  rig_.planner = restarted;
  rig_.step();
  EXPECT_EQ(path().id, kFirstId) << "the id of the restored path";
  EXPECT_EQ(path().points.size(), points);
  EXPECT_TRUE(rig_.planner.active_path().segment().reverse);
}

TEST_F(FullLevelTest, AReversingRoverOffItsPathIsStoppedBeforeAHazard) {
  send_map(channel_map);
  rig_.step();
  ASSERT_TRUE(rig_.planner.active_path().segment().reverse);
  rig_.forward_mps = -0.2;
  rig_.odom.x_m = -0.3;
  EXPECT_TRUE(std::isinf(rig_.look().status.blocked_in_m));
  rig_.odom.y_m = 0.21;
  rig_.odom.yaw_rad = -0.1;
  EXPECT_LT(rig_.look().status.blocked_in_m, 0.5);
}

TEST_F(FullLevelTest, ABlockedGapIsLeftForAnotherOne) {
  const auto gaps = [](bool near_open) {
    return [=](Point2 p) {
      const bool gap = (near_open && std::abs(p.y_m) < 1.0) || std::abs(p.y_m - 3.5) < 1.2;
      return impassable_if(std::abs(p.x_m - 4.0) < 0.15 && !gap);
    };
  };
  const auto y_at_wall = [&] {
    for (const RoutePoint& point : path().points)
      if (point.p.x_m >= 4.0) return point.p.y_m;
    return kNaN;
  };
  send_map(gaps(true));
  rig_.step();
  EXPECT_NEAR(y_at_wall(), 0.0, 0.6);
  for (int i = 0; i < 5; ++i) {
    send_map(gaps(false));
    rig_.step();
  }
  EXPECT_NEAR(y_at_wall(), 3.5, 0.8);
}

TEST_F(FullLevelTest, WithoutAPathOnTheMapItBacksUp) {
  rig_.planner.set_start_area({0.0, 0.0}, 5.0, rig_.now);
  rig_.move_to(1.5, 0.0);
  const CostAt enclosed = [](Point2 p) {
    const bool sides = std::abs(std::abs(p.y_m) - 0.85) < 0.1 && p.x_m < 3.2;
    return impassable_if(sides || std::abs(p.x_m - 3.1) < 0.15 || std::abs(p.x_m + 1.5) < 0.15);
  };
  for (int i = 0; i < planner_config().patience + 3 && rig_.planner.mode() != Mode::kBackingUp; ++i) {
    send_map(enclosed);
    rig_.step();
  }
  EXPECT_EQ(path().kind, PathKind::kBacktrack);
}

// It stops past the end of the global path and 6 m beside it.
TEST_F(FullLevelTest, ARoverThatBacksUpBesideTheGoalIsNotAtTheGoal) {
  rig_.send_path({{0.0, 0.0}, {8.0, 0.0}});
  rig_.step();
  rig_.move_to(1.0, 0.0);
  rig_.planner.request_back_up(true);
  rig_.look(2);
  ASSERT_EQ(path().kind, PathKind::kBacktrack);
  rig_.T_map_odom = {7.0, -6.0, 0.0};
  rig_.step();
  const PlannerOutput out = rig_.step();
  ASSERT_EQ(path().kind, PathKind::kBacktrack);
  EXPECT_GT(out.status.goal_distance_m, 5.5);
}

TEST_F(FullLevelTest, AGoalWithARockOnItIsReachedBesideTheRock) {
  rig_.send_path({{0.0, 0.0}, {6.0, 0.0}});
  const CostAt rock = [](Point2 p) { return impassable_if(distance(p, {6.0, 0.0}) < 0.35); };
  rig_.rocks = {{{6.0, 0.0}, 0.35, 0.4}};
  rig_.step();
  for (int i = 0; i < 60 && rig_.look().status.goal_distance_m > 0.2; ++i) {
    send_map(rock);
    rig_.go(0.5);
  }
  EXPECT_LT(rig_.look().status.goal_distance_m, 0.2);
  EXPECT_LT(distance(position(rig_.odom), {6.0, 0.0}), planner_config().planner.cost_to_go.blocked_goal_radius_m + 0.1);
}

}  // namespace
}  // namespace rover::planning
