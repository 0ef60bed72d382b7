// The planner's behaviour: which path it publishes, what blocks it, and what it says.
#include "path_planner/path_planner.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::clearance_along_m;
using testing_support::planner_config;
using testing_support::PlannerRig;
using testing_support::Rock;

const std::vector<Point2> kAhead = {{0.0, 0.0}, {20.0, 0.0}};
const Rock kOnPath{{3.0, 0.1}, 0.25, 0.3};

// Hands over a plan when it is allowed to.
class HeldBackground final : public Background {
 public:
  bool start(PlanJob job, Utime /*now*/) override {
    job_ = std::move(job);
    ++started;
    return true;
  }
  std::optional<Plan> result(Utime /*now*/) override {
    if (!job_ || !release) return std::nullopt;
    return std::exchange(job_, nullptr)();
  }
  int started = 0;
  bool release = false;

 private:
  PlanJob job_;
};

// A ring of rocks around the origin without a gap.
std::vector<Rock> ring(double radius_m) {
  std::vector<Rock> rocks;
  for (int deg = 0; deg < 360; deg += 5)
    rocks.push_back({{radius_m * std::cos(to_rad(deg)), radius_m * std::sin(to_rad(deg))}, 0.2, 0.3});
  return rocks;
}

void look_around(PlannerRig& rig, int frames) {
  for (int deg = -180; deg <= 180; deg += 20) {
    rig.odom.yaw_rad = to_rad(deg);
    rig.look(frames);
  }
  rig.odom.yaw_rad = 0.0;
}

size_t hazards(const PlannerRig& rig) {
  return Costmap({}, rig.planner.belief(), position(rig.odom), 20.0).hazards().size();
}

int patience() {
  return planner_config().patience;
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
  const PlannerOutput out = rig.look();
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

TEST(PathPlanner, UnknownGroundAheadBlocks) {
  PlannerRig rig;
  rig.send_path(kAhead);
  const PlannerOutput out = rig.look(2);
  EXPECT_EQ(out.status.block_kind, BlockKind::kUnseen);
  EXPECT_GT(out.status.blocked_in_m, 2.0);
  EXPECT_LT(out.status.blocked_in_m, 4.0 - 0.875 + 0.15);
}

TEST(PathPlanner, ARockOnThePathIsPassedWithClearance) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kOnPath};
  const PlannerOutput out = rig.look(2);
  const LocalPath path = rig.paths.back();
  EXPECT_EQ(path.kind, PathKind::kRepair);
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_EQ(out.status.path_id, path.id);
  EXPECT_GT(out.status.blocked_in_m, 1.0);
  EXPECT_GT(clearance_along_m(path, rig.rocks), 0.0);
  EXPECT_NEAR(distance(path.points.front().p, position(rig.odom)), 0.0, 0.05);
  EXPECT_NEAR(distance(path.points.back().p, kAhead.back()), 0.0, 1e-6);
  for (size_t i = 1; i < path.points.size(); ++i) EXPECT_LT(distance(path.points[i - 1].p, path.points[i].p), 0.17);
  rig.go(1.5);
  EXPECT_GT(clearance_along_m(rig.paths.back(), rig.rocks), 0.05);
}

TEST(PathPlanner, AFurtherHazardOnARepairIsPassedToo) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kOnPath};
  rig.look(2);
  const LocalPath first = rig.paths.back();
  ASSERT_EQ(first.kind, PathKind::kRepair);
  const Route repair(first.points);
  rig.rocks.push_back({repair.point_at(repair.closest(kOnPath.p)), 0.2, 0.3});
  rig.look(4);
  EXPECT_GT(rig.paths.back().id, first.id);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kRepair);
  EXPECT_GT(clearance_along_m(rig.paths.back(), rig.rocks), 0.05);
}

TEST(PathPlanner, PastTheRockItFollowsTheGlobalPathAgain) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kOnPath};
  rig.look(2);
  const PlannerOutput out = rig.go(14.0);
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kGlobal);
  EXPECT_EQ(rig.paths.back().corridor_half_width_m, 0.75);
  EXPECT_LT(out.status.corridor_offset_m, 0.05);
  EXPECT_GT(rig.odom.x_m, 12.0);
}

TEST(PathPlanner, AHazardBesideTheRoverBlocksAPointTurn) {
  PlannerRig rig(std::make_shared<HeldBackground>());
  rig.odom = {-1.5, -0.3, 0.0};
  rig.send_path({{-1.5, -0.3}, {10.0, -0.3}});
  rig.rocks = {{{0.0, 0.45}, 0.12, 0.3}};
  rig.look(2);
  rig.move_to(0.0, -0.3);
  rig.rocks.clear();  // out of view
  rig.send_path({position(rig.odom), {rig.odom.x_m, 10.0}}, 8);
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.status.block_kind, BlockKind::kHazard);
  EXPECT_NEAR(out.status.blocked_in_m, 0.0, 1e-9);
}

TEST(PathPlanner, APointTurnOnThePathMayPassAHazardThatItsEndClears) {
  PlannerRig rig(std::make_shared<HeldBackground>());
  rig.odom = {-2.5, 0.0, 0.0};
  rig.send_path({{-2.5, 0.0}, {0.0, 0.0}, {0.0, 10.0}});
  rig.rocks = {{{0.65, -0.65}, 0.05, 0.3}};
  rig.look(5);
  rig.camera.far_m = rig.camera.near_m;
  rig.move_to(-0.05, 0.0);
  for (const double yaw_rad : {0.0, 0.3, 0.6, 0.9, 1.2, 0.5 * kPi}) {
    rig.odom.yaw_rad = yaw_rad;
    const PlannerOutput out = rig.look();
    EXPECT_TRUE(out.status.block_kind != BlockKind::kHazard) << yaw_rad << " rad, in " << out.status.blocked_in_m;
    EXPECT_EQ(rig.planner.mode(), Mode::kFollowing) << yaw_rad;
  }
  // It lies where the rover would be if it had only half turned.
  EXPECT_EQ(hazards(rig), 1u);
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

TEST(PathPlanner, AGlobalPathThatArrivesBeforeAPoseWaitsForOne) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.now = 100'000;
  EXPECT_FALSE(rig.step_without_pose().path);
  EXPECT_TRUE(rig.step().path);
}

TEST(PathPlanner, AnUnusablePoseStopsTheRover) {
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

TEST(PathPlanner, FramesNeedAPoseOfTheirExposure) {
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

TEST(PathPlanner, InvalidGlobalPathsAreRefusedAndTheOldOneStays) {
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

TEST(PathPlanner, AGlobalPathWithoutCorridorGetsTheConfiguredOne) {
  PlannerRig rig;
  EXPECT_EQ(rig.planner.set_global_path({9, {{{0, 0}}, {{5, 0}}}, kNaN, kNaN}), "");
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->corridor_half_width_m, planner_config().corridor_half_width_m);
  EXPECT_EQ(out.path->goal_tolerance_m, planner_config().goal_tolerance_m);
}

TEST(PathPlanner, FarFromTheGlobalPathAPathToItIsPlanned) {
  PlannerRig rig;
  rig.odom = {0.0, -1.2, 0.0};
  rig.send_path(kAhead);
  const PlannerOutput out = rig.look(2);
  ASSERT_FALSE(rig.paths.empty());
  EXPECT_EQ(rig.paths.back().kind, PathKind::kRepair);
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_NEAR(distance(rig.paths.back().points.front().p, position(rig.odom)), 0.0, 0.01);
  EXPECT_EQ(out.status.replans, 0) << "no hazard was the reason";
  rig.go(12.0);
  EXPECT_LT(std::abs(rig.odom.y_m), 0.1);
}

// The legs coincide, so rounding decides which of them is nearer to the rover.
TEST(PathPlanner, APathThatReturnsToItsStartIsDrivenFromTheStart) {
  for (const double y_m : {-0.1, -0.001, 0.0, 0.001, 0.1}) {
    PlannerRig rig;
    rig.odom = {0.05, y_m, kPi};
    ASSERT_EQ(rig.send_path({{0.0, 0.0}, {6.7, 3.1}, {0.0, 0.0}}), "");
    const PlannerOutput out = rig.step();
    EXPECT_GT(out.status.goal_distance_m, 14.0);
    ASSERT_EQ(rig.paths.size(), 1u);
    EXPECT_GT(Route(rig.paths[0].points).length_m(), 14.0);
  }
}

TEST(PathPlanner, AGlobalPathThatBeginsFartherOffIsJoinedMidway) {
  PlannerRig rig;
  rig.odom = {5.0, 0.2, 0.0};
  ASSERT_EQ(rig.send_path(kAhead), "");
  EXPECT_NEAR(rig.step().status.goal_distance_m, 15.0, 0.1);
}

TEST(PathPlanner, EnclosedByRocksItSaysThatThereIsNoPath) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = ring(1.7);
  look_around(rig, 2);
  const PlannerOutput out = rig.look(10);
  EXPECT_EQ(out.status.state, PlannerState::kNoPath);
  EXPECT_EQ(out.status.block_kind, BlockKind::kHazard);
  EXPECT_LT(out.status.blocked_in_m, 0.6);
  EXPECT_EQ(out.status.text, "no path: hazards on all sides");
  const size_t before = rig.paths.size();
  rig.look(10);
  EXPECT_EQ(rig.paths.size(), before) << "no path through rocks";
}

TEST(PathPlanner, LeavesNoPathWhenTheGroundTurnsOutFree) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = ring(1.7);
  look_around(rig, 2);
  ASSERT_EQ(rig.look(10).status.state, PlannerState::kNoPath);
  rig.rocks.clear();
  look_around(rig, 3);
  EXPECT_NE(rig.look(10).status.state, PlannerState::kNoPath);
}

TEST(PathPlanner, OnUnknownGroundItSaysThatThereIsNoPath) {
  PlannerRig rig;
  rig.planner.set_start_area({0.0, 0.0}, 0.0, 0);
  rig.send_path(kAhead);
  PlannerOutput out = rig.step();
  EXPECT_EQ(out.status.block_kind, BlockKind::kUnseen);
  EXPECT_LT(out.status.blocked_in_m, 0.35);
  rig.camera.near_m = 2.5;  // sees only ground further on
  out = rig.look(patience() + 1);
  EXPECT_EQ(out.status.state, PlannerState::kNoPath);
  EXPECT_EQ(out.status.text, "no path: the ground ahead does not come into view");
  EXPECT_EQ(out.status.replans, 0);
  EXPECT_EQ(rig.paths.size(), 1u);
  rig.planner.set_start_area({0.0, 0.0}, 2.0, rig.now);
  EXPECT_NE(rig.step().status.state, PlannerState::kNoPath);
}

// Finds plans to back up only.
template <bool kClosedIn>
class BackUpPlanner final : public Planner {
 public:
  explicit BackUpPlanner(const HybridPlannerConfig& config) : hybrid_(config) {}
  Plan plan(const PlanRequest& request) const override {
    return request.back_to.empty() ? Plan{.closed_in = kClosedIn} : hybrid_.plan(request);
  }

 private:
  HybridPlanner hybrid_;
};
template <bool kClosedIn>
std::shared_ptr<const Planner> make_back_up_planner(const HybridPlannerConfig& config) {
  return std::make_shared<const BackUpPlanner<kClosedIn>>(config);
}

TEST(PathPlanner, APlanBeginsWhereTheRoverIsBesideItsPath) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look();
  rig.go(2.0);
  rig.rocks = {{{rig.odom.x_m + 3.0, 0.0}, 0.3, 0.4}};
  rig.odom.y_m = 0.08;
  rig.forward_mps = 0.2;
  const size_t before = rig.paths.size();
  for (int i = 0; i < 5 && rig.paths.size() == before; ++i) rig.look();
  ASSERT_GT(rig.paths.size(), before);
  const Route route(rig.paths.back().points);
  const double here_m = route.closest(position(rig.odom));
  EXPECT_LT(distance(route.point_at(here_m), position(rig.odom)), 0.02);
}

// A rover at the end of a driven track.
class BackUpTest : public testing::Test {
 protected:
  static constexpr double kTrackM = 9.0;

  static void SetUpTestSuite() {
    add_planner("back_up", make_back_up_planner<false>);
    add_planner("back_up_closed_in", make_back_up_planner<true>);
  }
  void SetUp() override { set_up("back_up"); }
  void set_up(const std::string& planner) {
    PathPlannerConfig config = planner_config();
    config.planner_name = planner;
    rig_ = PlannerRig();
    rig_.planner = PathPlanner(config, 1);
    rig_.planner.set_start_area({0.0, 0.0}, 2.0, 0);
    rig_.send_path(kAhead);
    rig_.step();
    rig_.move_to(kTrackM, 0.0);
  }
  void wait_for_back_up() {
    for (int i = 0; i < patience() + 3 && rig_.planner.mode() != Mode::kBackingUp; ++i) rig_.look();
  }
  // In reverse to the end of the path.
  void back_up() {
    const Route route(rig_.paths.back().points);
    rig_.forward_mps = -0.1;
    for (double s = 0.0; s <= route.length_m() + 0.05; s += 0.05) {
      const Pose2 pose = route.pose_at(s);
      rig_.odom = {pose.x_m, pose.y_m, pose.yaw_rad + kPi};
      rig_.look();
    }
    rig_.forward_mps = 0.0;
    rig_.look();
  }
  PlannerRig rig_;
};

TEST_F(BackUpTest, WithoutAPathItBacksUpOverTheDrivenTrack) {
  wait_for_back_up();
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
  const LocalPath path = rig_.paths.back();
  EXPECT_EQ(path.kind, PathKind::kBacktrack);
  EXPECT_EQ(path.corridor_half_width_m, planner_config().min_corridor_m);
  EXPECT_NEAR(distance(path.points.front().p, position(rig_.odom)), 0.0, 0.11);
  for (const RoutePoint& point : path.points) EXPECT_NEAR(point.p.y_m, 0.0, 1e-9);
  EXPECT_NEAR(path.points.back().p.x_m, rig_.odom.x_m - planner_config().back_up_m, 0.21);
  EXPECT_EQ(rig_.look().status.state, PlannerState::kRepairing);
}

TEST_F(BackUpTest, ItBacksUpFurtherEachTimeUntilTheTrackEnds) {
  for (const int times : {1, 2, 3}) {
    wait_for_back_up();
    ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
    EXPECT_NEAR(Route(rig_.paths.back().points).length_m(), times * planner_config().back_up_m, 0.15);
    back_up();
    ASSERT_EQ(rig_.planner.mode(), Mode::kPlanning);
  }
  wait_for_back_up();
  back_up();
  EXPECT_NEAR(rig_.odom.x_m, 0.0, 0.3);
  EXPECT_EQ(rig_.look(patience() + 2).status.state, PlannerState::kNoPath);
}

TEST_F(BackUpTest, WhereNoWayIsOpenItBacksUpOnce) {
  set_up("back_up_closed_in");
  wait_for_back_up();
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
  back_up();
  EXPECT_EQ(rig_.look(patience() + 2).status.state, PlannerState::kNoPath);
}

// The rover has turned and come back.
TEST_F(BackUpTest, APathThatPassesAPlaceTwiceIsFollowedToItsEnd) {
  rig_.odom.yaw_rad = kPi;
  rig_.move_to(kTrackM - 0.4, 0.0);
  wait_for_back_up();
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
  const LocalPath path = rig_.paths.back();
  ASSERT_LT(path.points.back().p.x_m, rig_.odom.x_m - 0.2);
  rig_.forward_mps = -0.1;
  for (const RoutePoint& point : path.points) {
    rig_.odom = {point.p.x_m, point.p.y_m, kPi};
    rig_.look();
    ASSERT_EQ(rig_.paths.back().id, path.id);
  }
  rig_.forward_mps = 0.0;
  rig_.look();
  EXPECT_NE(rig_.planner.mode(), Mode::kBackingUp);
}

// Ground beside the track was never seen.
TEST_F(BackUpTest, BesideItsTrackItBacksUpOntoIt) {
  rig_.move_to(kTrackM, 0.2);
  rig_.forward_mps = 0.0;
  wait_for_back_up();
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
  const Route route(rig_.paths.back().points);
  EXPECT_GT(route.length_m(), planner_config().back_up_m - 0.15);
  EXPECT_NEAR(route.points().back().p.y_m, 0.0, 0.11);
  EXPECT_TRUE(std::isinf(rig_.look().status.blocked_in_m));
}

TEST_F(BackUpTest, SlidingTowardsARockWhileBackingUpItStops) {
  rig_.rocks = {{{kTrackM + 2.0, 0.85}, 0.2, 0.3}};
  rig_.look(2);
  rig_.move_to(kTrackM + 3.6, 0.0);
  wait_for_back_up();
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
  rig_.forward_mps = -0.1;
  rig_.odom.x_m = kTrackM + 3.5;
  EXPECT_TRUE(std::isinf(rig_.look().status.blocked_in_m));
  rig_.odom = {kTrackM + 3.2, 0.2, -0.15};
  EXPECT_LT(rig_.look().status.blocked_in_m, 0.6);
  rig_.forward_mps = 0.0;
  rig_.look(2);
  EXPECT_NE(rig_.planner.mode(), Mode::kBackingUp);
}

TEST_F(BackUpTest, StoppedByFdirWhileBackingUpItPlansAgain) {
  wait_for_back_up();
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp);
  rig_.look(20);
  ASSERT_EQ(rig_.planner.mode(), Mode::kBackingUp) << "undisturbed it goes on";
  rig_.planner.request_replan();
  rig_.look();
  EXPECT_NE(rig_.planner.mode(), Mode::kBackingUp);
}

TEST(PathPlanner, OnRequestItBacksUpTwiceAtMost) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look();
  rig.go(5.0);
  rig.planner.request_back_up(true);
  rig.forward_mps = 0.1;
  rig.look(3);
  EXPECT_NE(rig.planner.mode(), Mode::kBackingUp) << "not before it has stopped";
  rig.forward_mps = 0.0;
  rig.planner.request_back_up(false);
  rig.look(3);
  EXPECT_NE(rig.planner.mode(), Mode::kBackingUp) << "the fault is over";
  int back_ups = 0;
  for (int i = 0; i < 4; ++i) {
    rig.planner.request_back_up(true);
    rig.look(2);
    if (rig.planner.mode() != Mode::kBackingUp) continue;
    ++back_ups;
    const Point2 end = rig.paths.back().points.back().p;
    EXPECT_NEAR(rig.odom.x_m - end.x_m, planner_config().back_up_m * back_ups + 0.15, 0.2);
    rig.odom = {end.x_m, end.y_m, 0.0};
    rig.look(3);
    EXPECT_EQ(rig.planner.mode(), Mode::kFollowing) << "from there it drives on";
  }
  EXPECT_EQ(back_ups, 2);
  PlannerOutput out = rig.look(20);
  EXPECT_EQ(out.status.state, PlannerState::kNoPath);
  EXPECT_EQ(out.status.text, "cannot back up from the fault");
  rig.planner.request_back_up(false);
  out = rig.look(3);
  EXPECT_EQ(rig.planner.mode(), Mode::kFollowing) << "the fault is over";
}

// After 5 m forward, in reverse in steps until it is so far off its track; then FDIR wants it to back up.
void reverse_beside_track(PlannerRig& rig, Point2 step, double aside_m) {
  rig.send_path(kAhead);
  rig.look();
  rig.go(5.0);
  rig.forward_mps = -0.1;
  for (const Pose2 from = rig.odom; rig.odom.y_m > from.y_m - aside_m;) {
    rig.odom = {rig.odom.x_m + step.x_m, rig.odom.y_m + step.y_m, 0.0};
    rig.step();
  }
  rig.forward_mps = 0.0;
  rig.planner.request_back_up(true);
  rig.look(2);
}

TEST(PathPlanner, BackingUpLeadsBackFromARoverThatHasReversedBesideItsTrack) {
  PlannerRig rig;
  reverse_beside_track(rig, {-0.02, -0.007}, 0.21);
  ASSERT_EQ(rig.planner.mode(), Mode::kBackingUp);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kBacktrack);
  for (const RoutePoint& point : rig.paths.back().points) EXPECT_LT(point.p.x_m, rig.odom.x_m + 0.1);
  EXPECT_LT(rig.paths.back().points.back().p.x_m, rig.odom.x_m - 0.8);
}

TEST(PathPlanner, AfterAFaultItBacksUpOverKnownGroundIfTheTrackDoesNotLeadBack) {
  PlannerRig rig;
  reverse_beside_track(rig, {-0.01, -0.02}, 0.6);
  EXPECT_EQ(rig.planner.mode(), Mode::kBackingUp);
}

TEST(PathPlanner, OnRequestARoverThatHasNotDrivenYetCannotBackUp) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.look();
  rig.planner.request_back_up(true);
  EXPECT_EQ(rig.look(3).status.text, "cannot back up from the fault");
  EXPECT_EQ(rig.planner.mode(), Mode::kNoPath);
}

TEST(PathPlanner, OnRequestAClearPathIsReplacedOnce) {
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

TEST(PathPlanner, AGoalWithARockOnItIsReachedBesideTheRock) {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {6.0, 0.0}});
  const Rock on_goal{{6.0, 0.0}, 0.25, 0.4};
  rig.rocks = {on_goal};
  rig.look(3);
  PlannerOutput out;
  for (int i = 0; i < 40 && !(out.status.goal_distance_m < 0.1); ++i) {
    rig.go(0.5);
    out = rig.look(2);
  }
  EXPECT_LT(out.status.goal_distance_m, 0.1);
  EXPECT_EQ(out.status.text, "the goal is blocked: the path ends beside it");
  EXPECT_LT(distance(position(rig.odom), on_goal.p), planner_config().planner.cost_to_go.blocked_goal_radius_m + 0.1);
  EXPECT_GT(clearance_m(planner_config().footprint, rig.odom, rig.rocks), 0.0);
}

TEST(PathPlanner, BeforeTheFirstPlanToAPathFarOffItDoesNotSayThatThereIsNone) {
  const auto background = std::make_shared<HeldBackground>();
  PlannerRig rig(background);
  rig.send_path({{5.0, 3.0}, {20.0, 3.0}});
  const PlannerOutput out = rig.look(3);
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_EQ(out.status.text, "cannot reach the global path yet");
  EXPECT_EQ(out.status.blocked_in_m, 0.0);
  EXPECT_TRUE(rig.paths.empty());
}

// A start pose moves map against odom, in which hazards and the driven track lie.
TEST(PathPlanner, AStartAreaIsKnownAndKeepsWhatWasSeen) {
  PlannerRig rig;
  rig.send_path(kAhead);
  rig.rocks = {kOnPath};
  rig.look(3);
  const size_t before = hazards(rig);
  EXPECT_GT(before, 0u);
  rig.rocks.clear();
  const auto unknown = [&](Point2 p) { return Costmap({}, rig.planner.belief(), {}, 20.0).unknown(p); };
  EXPECT_TRUE(unknown({-3.9, 0.0}));
  rig.planner.set_start_area({0.0, 0.0}, 4.0, rig.now);
  const PlannerOutput out = rig.step();
  EXPECT_EQ(hazards(rig), before);
  EXPECT_FALSE(unknown({-3.9, 0.0}));
  EXPECT_TRUE(unknown({-4.3, 0.0}));
  EXPECT_TRUE(out.path);
}

TEST(PathPlanner, PathIdsAreNeverUsedTwice) {
  PlannerRig rig;
  rig.rocks = {kOnPath};
  for (int i = 0; i < 3; ++i) {
    rig.send_path(kAhead, 7 + i);
    rig.look(3);
    rig.planner.request_replan();
    rig.look(3);
  }
  ASSERT_GT(rig.paths.size(), 4u);
  for (size_t i = 1; i < rig.paths.size(); ++i) EXPECT_GT(rig.paths[i].id, rig.paths[i - 1].id);
}

TEST(PathPlanner, TheSameInputsGiveTheSameBytes) {
  PlannerRig a;
  PlannerRig b;
  for (PlannerRig* rig : {&a, &b}) {
    rig->send_path({{0.0, 0.0}, {8.0, 1.0}, {20.0, 0.0}});
    rig->camera.false_hit_rate = 0.5;
    rig->rocks = {kOnPath, {{6.0, 1.2}, 0.3, 0.3}};
    rig->look(2);
    rig->go(6.0);
  }
  EXPECT_EQ(a.planner.save(), b.planner.save());
  ASSERT_EQ(a.paths.size(), b.paths.size());
  EXPECT_GE(a.paths.size(), 2u);
  for (size_t i = 0; i < a.paths.size(); ++i) {
    ASSERT_EQ(a.paths[i].points.size(), b.paths[i].points.size());
    for (size_t k = 0; k < a.paths[i].points.size(); ++k) {
      EXPECT_EQ(a.paths[i].points[k].p.x_m, b.paths[i].points[k].p.x_m);
      EXPECT_EQ(a.paths[i].points[k].p.y_m, b.paths[i].points[k].p.y_m);
    }
  }
}

class BackgroundPlanTest : public testing::Test {
 protected:
  BackgroundPlanTest() {
    rig_.send_path(kAhead);
    rig_.step();
  }
  std::shared_ptr<HeldBackground> background_ = std::make_shared<HeldBackground>();
  PlannerRig rig_{background_};
};

TEST_F(BackgroundPlanTest, FramesAreCheckedWhileAPlanIsMade) {
  rig_.rocks = {kOnPath};
  rig_.look(2);
  EXPECT_EQ(background_->started, 1);
  rig_.rocks.push_back({{1.6, 0.0}, 0.2, 0.3});
  EXPECT_LT(rig_.look(4).status.blocked_in_m, 1.0);
  EXPECT_EQ(background_->started, 1);
  EXPECT_EQ(rig_.paths.size(), 1u);
}

TEST_F(BackgroundPlanTest, APlanIsAdoptedWhenItIsReady) {
  rig_.rocks = {kOnPath};
  rig_.look(3);
  background_->release = true;
  EXPECT_TRUE(rig_.step().path);
  EXPECT_EQ(rig_.paths.back().kind, PathKind::kRepair);
}

TEST_F(BackgroundPlanTest, APlanForAnotherGlobalPathIsDropped) {
  rig_.rocks = {kOnPath};
  rig_.look(3);
  rig_.rocks.clear();
  rig_.send_path({{0.0, 0.0}, {0.0, 20.0}}, 8);
  background_->release = true;
  rig_.step();
  rig_.step();
  for (const LocalPath& path : rig_.paths) EXPECT_EQ(path.kind, PathKind::kGlobal);
}

TEST_F(BackgroundPlanTest, AMovingRoverKeepsThePathOnWhichItStopsInTime) {
  rig_.forward_mps = 0.2;
  rig_.rocks = {kOnPath};
  background_->release = true;
  rig_.look(2);
  const LocalPath path = rig_.paths.back();
  ASSERT_EQ(path.kind, PathKind::kRepair);
  const Route route(path.points);
  for (double s = 0.0; s < 0.2; s += 0.05) EXPECT_NEAR(route.point_at(s).y_m, 0.0, 0.01);
}

}  // namespace
}  // namespace rover::planning
