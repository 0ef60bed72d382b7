// What the rover remembers of the ground: hits are confirmed, cleared, doubted, kept beside it and forgotten behind it.
#include "path_planner/hazard_memory.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "path_planner/terrain.hpp"

namespace rover::planning {
namespace {

constexpr Point2 kRock{2.05, 0.25};
const Footprint kFootprint{0.875, 0.47};

// The shape of hazard_detector's grid.
HazardGrid frame(std::uint8_t value) {
  return {0, 0.1, 0.5, -2.0, 35, 40, std::vector<std::uint8_t>(1400, value)};
}

HazardGrid frame_with(std::uint8_t at_rock, Point2 rock_in_body, std::uint8_t elsewhere = HazardGrid::kFree) {
  HazardGrid grid = frame(elsewhere);
  const int ix = static_cast<int>(std::floor((rock_in_body.x_m - grid.origin_x_m) / grid.cell_m));
  const int iy = static_cast<int>(std::floor((rock_in_body.y_m - grid.origin_y_m) / grid.cell_m));
  grid.cells[static_cast<size_t>(iy) * grid.cells_x + ix] = at_rock;
  return grid;
}

class HazardMemoryTest : public testing::Test {
 protected:
  // A frame from the pose that sees `value` at the rock.
  void see(std::uint8_t value, const Pose2& from = {0.0, 0.0, 0.0}) {
    memory_.add(frame_with(value, to_body(from, kRock)), from_planar(from), 0.0);
  }
  void see(std::uint8_t value, int times, const Pose2& from = {0.0, 0.0, 0.0}) {
    for (int i = 0; i < times; ++i) see(value, from);
  }
  const GroundCell& at(Point2 p) const { return memory_.map().get(memory_.map().index_of(p.x_m, p.y_m)); }
  bool confirmed() const { return memory_.confirmed(at(kRock)); }

  HazardMemoryConfig config_;
  HazardMemory memory_{config_};

  void SetUp() override { memory_.move_to({0.0, 0.0}); }
};

TEST_F(HazardMemoryTest, ASecondHitConfirms) {
  see(HazardGrid::kObstacle);
  EXPECT_EQ(at(kRock).hits, 1);
  EXPECT_FALSE(confirmed());
  see(HazardGrid::kHole);
  EXPECT_TRUE(confirmed());
}

TEST_F(HazardMemoryTest, HitsAreCountedOncePerFrameAndHaveABound) {
  // Turned by 45 degrees two cells of the frame may fall into one of the map.
  HazardGrid all = frame(HazardGrid::kObstacle);
  memory_.add(all, from_planar({0.0, 0.0, to_rad(45.0)}), 0.0);
  memory_.map().for_each([](CellIndex, const GroundCell& cell) { ASSERT_LE(cell.hits, 1); });
  for (int i = 0; i < 300; ++i) memory_.add(all, from_planar({0.0, 0.0, to_rad(45.0)}), 0.0);
  memory_.map().for_each([](CellIndex, const GroundCell& cell) { ASSERT_LE(cell.hits, 20); });
}

TEST_F(HazardMemoryTest, ASingleHitIsClearedByFreeFrames) {
  see(HazardGrid::kObstacle);
  see(HazardGrid::kFree, config_.possible_clear - 1);
  EXPECT_EQ(at(kRock).hits, 1);
  see(HazardGrid::kFree);
  EXPECT_EQ(at(kRock).hits, 0);
}

TEST_F(HazardMemoryTest, AHitWhereTheGroundWasOftenFreeIsDoubtful) {
  see(HazardGrid::kFree, config_.possible_clear);
  see(HazardGrid::kObstacle);
  EXPECT_EQ(at(kRock).hits, 0) << "the first hit against many free frames";
  see(HazardGrid::kObstacle);
  see(HazardGrid::kObstacle);
  EXPECT_TRUE(confirmed()) << "but it does not shut out further ones";
}

TEST_F(HazardMemoryTest, AConfirmedHazardIsOnlyClearedFromCloseBy) {
  const Pose2 far{-1.5, 0.0, 0.0};
  const Pose2 close{0.5, 0.0, 0.0};
  see(HazardGrid::kObstacle, 2);
  see(HazardGrid::kFree, 50, far);
  EXPECT_TRUE(confirmed());
  see(HazardGrid::kFree, config_.confirmed_clear - 1, close);
  EXPECT_TRUE(confirmed());
  see(HazardGrid::kFree, 1, close);
  EXPECT_EQ(at(kRock).hits, 0);
}

// A rock at the limit is a hazard in some frames: told free and found again, it has to be seen free for twice as long.
TEST_F(HazardMemoryTest, EachRelapseDoublesTheFramesThatTellGroundFree) {
  const Pose2 close{0.5, 0.0, 0.0};
  const auto frames_until_free = [&] {
    int frames = 0;
    for (; !memory_.surely_free(at(kRock)) && frames < 1000; ++frames) see(HazardGrid::kFree, close);
    return frames;
  };
  for (const int times : {1, 2, 4, 8, 16, 16}) {
    EXPECT_EQ(frames_until_free(), times * config_.sure_free);
    see(HazardGrid::kObstacle, close);
    EXPECT_FALSE(memory_.refutes(at(kRock)));
  }
  see(HazardGrid::kObstacle, 2, close);
  see(HazardGrid::kFree, 16 * config_.confirmed_clear - 1, close);
  EXPECT_TRUE(confirmed());
  see(HazardGrid::kFree, close);
  EXPECT_FALSE(confirmed());
}

TEST(HazardMemory, HoweverManyFramesAreAskedForTheyAreCounted) {
  HazardMemoryConfig config;
  config.sure_free = config.confirmed_clear = 100;
  HazardMemory memory(config);
  memory.move_to({0.0, 0.0});
  const Pose2 close{0.5, 0.0, 0.0};
  const auto see = [&](std::uint8_t value, int times) {
    for (int i = 0; i < times; ++i) memory.add(frame_with(value, to_body(close, kRock)), from_planar(close), 0.0);
  };
  const auto cell = [&] { return memory.map().get(memory.map().index_of(kRock.x_m, kRock.y_m)); };
  for (int relapse = 0; relapse < 3; ++relapse) {
    see(HazardGrid::kFree, 260);
    EXPECT_TRUE(memory.surely_free(cell()));
    see(HazardGrid::kObstacle, 3);
    EXPECT_TRUE(memory.confirmed(cell()));
  }
  see(HazardGrid::kFree, 260);
  EXPECT_FALSE(memory.confirmed(cell()));
}

TEST_F(HazardMemoryTest, UnseenFramesAndMarginsClearNothing) {
  see(HazardGrid::kObstacle, 2);
  for (int i = 0; i < 50; ++i) {
    memory_.add(frame(HazardGrid::kUnseen), from_planar({0.5, 0.0, 0.0}), 0.0);
    memory_.add(frame(HazardGrid::kMargin), from_planar({0.5, 0.0, 0.0}), 0.0);
  }
  EXPECT_TRUE(confirmed());
}

TEST_F(HazardMemoryTest, OnlyWhatTheFrameSawIsSeen) {
  memory_.add(frame(HazardGrid::kUnseen), from_planar({0.0, 0.0, 0.0}), 0.0);
  EXPECT_FALSE(at({2.05, 0.05}).seen);
  for (const std::uint8_t value : {HazardGrid::kFree, HazardGrid::kMargin, HazardGrid::kObstacle, HazardGrid::kHole}) {
    memory_.clear();
    memory_.add(frame(value), from_planar({0.0, 0.0, 0.0}), 0.0);
    EXPECT_TRUE(at({2.05, 0.05}).seen) << int(value);
    EXPECT_FALSE(at({-1.05, 0.05}).seen) << int(value);
  }
}

// The paper's case: a rock that has left the view to the side counts when the rover turns on the spot.
TEST_F(HazardMemoryTest, HazardsBesideTheRoverAreKeptWhileItTurns) {
  see(HazardGrid::kObstacle, 2);
  for (int deg = 0; deg <= 360; deg += 10) {
    if (std::abs(deg % 360) <= 50 || deg >= 310) continue;  // the rock is in the view there
    memory_.add(frame(HazardGrid::kFree), from_planar({0.0, 0.0, to_rad(deg)}), 0.0);
  }
  EXPECT_TRUE(confirmed());
}

TEST_F(HazardMemoryTest, HazardsAreKeptBesideTheTrackAndForgottenFarBehind) {
  see(HazardGrid::kObstacle, 2);
  const double half_m = 0.5 * config_.cells * config_.cell_m;
  for (double x = 0.0; x < kRock.x_m + half_m - 0.2; x += 0.1) {
    memory_.move_to({x, 0.0});
    ASSERT_TRUE(confirmed()) << x;
  }
  memory_.move_to({kRock.x_m + half_m + 0.2, 0.0});
  EXPECT_FALSE(memory_.map().contains(kRock.x_m, kRock.y_m));
  memory_.move_to({0.0, 0.0});
  EXPECT_EQ(at(kRock).hits, 0) << "what left the grid does not come back with it";
  EXPECT_FALSE(at(kRock).seen);
}

TEST_F(HazardMemoryTest, TheFrameIsLaidWhereTheRoverWas) {
  const Pose2 from{1.3, -2.2, 2.0};
  const double c = std::cos(from.yaw_rad);
  const double s = std::sin(from.yaw_rad);
  const Point2 in_body{2.05, -0.75};
  const Point2 in_odom{from.x_m + c * in_body.x_m - s * in_body.y_m, from.y_m + s * in_body.x_m + c * in_body.y_m};
  memory_.move_to(position(from));
  memory_.add(frame_with(HazardGrid::kObstacle, in_body), from_planar(from), 0.0);
  EXPECT_EQ(at(in_odom).hits, 1);
  int hits = 0;
  memory_.map().for_each([&](CellIndex, const GroundCell& cell) { hits += cell.hits; });
  EXPECT_EQ(hits, 1);
}

// Pitched nose down by 10 degrees the ground ahead lies nearer in the plane than in the body's axes.
TEST_F(HazardMemoryTest, AttitudeIsTakenOutOfTheFrame) {
  const double pitch = to_rad(10.0);
  const Eigen::Isometry3d T = make_pose(rotation_from_rpy(0.0, pitch, 0.0), {0.0, 0.0, 0.0});
  memory_.add(frame_with(HazardGrid::kObstacle, {3.05, 0.05}), T, -0.62);
  const double expected = 3.05 * std::cos(pitch) - 0.62 * std::sin(pitch);
  EXPECT_EQ(at({expected, 0.05}).hits, 1);
}

TEST_F(HazardMemoryTest, GroundUnderTheRoverIsFreeWhateverWasThoughtOfIt) {
  see(HazardGrid::kObstacle, 5);
  memory_.mark_driven({kRock.x_m - 0.3, kRock.y_m, 0.2}, kFootprint);
  EXPECT_EQ(at(kRock).hits, 0);
  EXPECT_TRUE(at(kRock).seen);
}

TEST_F(HazardMemoryTest, GroundBesideTheDrivenTrackKeepsItsHazards) {
  see(HazardGrid::kObstacle, 5);
  memory_.mark_driven({kRock.x_m, kRock.y_m + 0.47 + 0.05, 0.0}, kFootprint);
  EXPECT_TRUE(confirmed());
}

TEST_F(HazardMemoryTest, ACertifiedCircleIsSeenAndKeepsItsHazards) {
  see(HazardGrid::kObstacle, 2);
  memory_.mark_seen({2.0, 0.0}, 1.5);
  EXPECT_TRUE(confirmed());
  memory_.map().for_each([&](CellIndex i, const GroundCell& cell) {
    const Point2 p{memory_.map().center_x_m(i), memory_.map().center_y_m(i)};
    EXPECT_TRUE(cell.seen || distance(p, {2.0, 0.0}) > 1.5);
  });
  EXPECT_FALSE(at({-1.0, 0.0}).seen);
}

// Ground that the camera looks at from close by and never sees is no ground that another view will show.
TEST_F(HazardMemoryTest, GroundLookedAtInVainFromCloseByBecomesAHazard) {
  const Point2 hole{1.55, 0.05};
  const auto look = [&] { memory_.add(frame(HazardGrid::kUnseen), from_planar({0.0, 0.0, 0.0}), 0.0); };
  for (int i = 0; i < config_.blind_looks - 1; ++i) look();
  EXPECT_FALSE(memory_.blind(at(hole)));
  EXPECT_TRUE(Terrain(memory_).hazards().empty());
  look();
  EXPECT_TRUE(memory_.blind(at(hole)));
  EXPECT_FALSE(memory_.blind(at({3.55, 0.05}))) << "too far away to be sure";
  EXPECT_FALSE(memory_.blind(at({1.55, 1.55}))) << "not in the view";
  EXPECT_FALSE(Terrain(memory_).hazards().empty());
  memory_.add(frame(HazardGrid::kFree), from_planar({0.0, 0.0, 0.0}), 0.0);
  EXPECT_FALSE(memory_.blind(at(hole)));
}

TEST_F(HazardMemoryTest, GroundThatIsBlindFromNearIsNotSeenFromFurtherOff) {
  const Point2 dust{1.95, 0.05};
  for (int i = 0; i < config_.blind_looks; ++i)
    memory_.add(frame(HazardGrid::kUnseen), from_planar({0.1 * i, 0.0, 0.0}), 0.0);
  const double nearest_x_m = 0.1 * (config_.blind_looks - 1);
  for (const std::uint8_t seen : {HazardGrid::kFree, HazardGrid::kMargin}) {
    memory_.add(frame(seen), from_planar({nearest_x_m - 0.2, 0.0, 0.0}), 0.0);
    EXPECT_TRUE(memory_.blind(at(dust))) << "seen from within clear_range_m, but not from as near as in vain";
  }
  memory_.add(frame(HazardGrid::kFree), from_planar({nearest_x_m, 0.0, 0.0}), 0.0);
  EXPECT_FALSE(memory_.blind(at(dust)));
}

TEST_F(HazardMemoryTest, GroundHiddenBehindAnObstacleIsNotBlind) {
  HazardGrid grid = frame(HazardGrid::kUnseen);
  for (int iy = 15; iy < 25; ++iy) grid.cells[static_cast<size_t>(iy) * grid.cells_x + 6] = HazardGrid::kObstacle;
  for (int i = 0; i < 3 * config_.blind_looks; ++i) memory_.add(grid, from_planar({0.0, 0.0, 0.0}), 0.0);
  EXPECT_FALSE(memory_.blind(at({1.65, 0.05})));
}

TEST(HazardGrid, AGridThatContradictsItselfIsRefusedWithAReason) {
  EXPECT_EQ(frame(0).fault(), "");
  const std::vector<std::function<void(HazardGrid&)>> faults = {
      [](HazardGrid& g) { g.cells_x = 0; },
      [](HazardGrid& g) { g.cells_y = -40; },
      [](HazardGrid& g) { g.cells_x = g.cells_y = 1 << 16; },
      [](HazardGrid& g) { g.cells.pop_back(); },
      [](HazardGrid& g) { g.cell_m = kNaN; },
      [](HazardGrid& g) { g.cell_m = 0.0; },
      [](HazardGrid& g) { g.origin_x_m = kInfinity; },
      [](HazardGrid& g) { g.origin_y_m = kNaN; },
      [](HazardGrid& g) { g.cells[7] = 5; },
  };
  for (size_t i = 0; i < faults.size(); ++i) {
    HazardGrid grid = frame(0);
    faults[i](grid);
    EXPECT_NE(grid.fault(), "") << i;
  }
}

}  // namespace
}  // namespace rover::planning
