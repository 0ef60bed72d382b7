// What the planner saves it gets back; bytes that are no state change nothing.
#include <gtest/gtest.h>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::planner_config;
using testing_support::PlannerRig;
using testing_support::uniform;

// A drive that has hazards in its memory and a repair as its active path.
PlannerRig driven() {
  PlannerRig rig;
  rig.send_path({{0.0, 0.0}, {20.0, 1.0}});
  rig.rocks = {{{3.0, 0.1}, 0.25, 0.3}, {{3.0, 1.9}, 0.15, 0.3}};
  rig.look(2);
  rig.go(1.0);
  return rig;
}

TEST(Checkpoint, WhatIsRestoredSavesTheSameBytes) {
  const std::vector<std::uint8_t> bytes = driven().planner.save();
  PathPlanner other(planner_config(), 1);
  ASSERT_TRUE(other.restore(bytes));
  EXPECT_EQ(other.save(), bytes);
  PathPlanner empty(planner_config(), 1);
  PathPlanner again(planner_config(), 1);
  ASSERT_TRUE(again.restore(empty.save()));
  EXPECT_EQ(again.save(), empty.save());
}

TEST(Checkpoint, ARestartedPlannerGoesOnWithThePathAndItsMemory) {
  PlannerRig rig = driven();
  const LocalPath before = rig.paths.back();
  ASSERT_EQ(before.kind, PathKind::kRepair);
  const size_t hazards = Terrain(rig.planner.memory()).hazards().size();
  PathPlanner restarted(planner_config(), 1'000'001);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  rig.planner = restarted;
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path) << "those who listen may have missed it";
  EXPECT_EQ(out.path->id, before.id);
  EXPECT_EQ(out.path->kind, before.kind);
  ASSERT_EQ(out.path->points.size(), before.points.size());
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_EQ(out.status.replans, 1);
  EXPECT_EQ(Terrain(rig.planner.memory()).hazards().size(), hazards);
  EXPECT_FALSE(rig.step().path) << "once is enough";
}

// Without that range no look would clear it any more.
TEST(Checkpoint, ARestartedPlannerKnowsFromHowNearGroundWasBlind) {
  PlannerRig rig = driven();
  rig.camera.near_m = 1.6;  // so much of the ground nearby is not seen any more
  rig.look(8);
  PathPlanner restarted(planner_config(), 1'000'001);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  const HazardMemory& memory = rig.planner.memory();
  int blind = 0;
  memory.map().for_each([&](CellIndex i, const GroundCell& cell) {
    if (!memory.blind(cell)) return;
    ++blind;
    ASSERT_GT(cell.vain_m, 0.9F);
    ASSERT_EQ(restarted.memory().map().get(i).vain_m, cell.vain_m);
  });
  EXPECT_GT(blind, 10);
}

TEST(Checkpoint, PathIdsOfARestartedPlannerAreNew) {
  PlannerRig rig = driven();
  PathPlanner restarted(planner_config(), 1'000'001);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  rig.planner = restarted;
  rig.send_path({{0.0, 0.0}, {20.0, 0.0}}, 8);
  rig.look(2);
  EXPECT_GE(rig.paths.back().id, 1'000'001);
}

TEST(Checkpoint, TruncatedAndLengthenedBytesAreRefused) {
  const std::vector<std::uint8_t> bytes = driven().planner.save();
  PathPlanner planner(planner_config(), 1);
  const std::vector<std::uint8_t> untouched = planner.save();
  for (size_t size = 0; size < bytes.size(); size += size < 500 ? 1 : 997)
    ASSERT_FALSE(planner.restore({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(planner.restore(longer));
  EXPECT_EQ(planner.save(), untouched);
}

TEST(Checkpoint, GarbageIsRefused) {
  std::mt19937_64 random(1);
  PathPlanner planner(planner_config(), 1);
  const std::vector<std::uint8_t> untouched = planner.save();
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> garbage(random() % 4000);
    for (std::uint8_t& b : garbage) b = static_cast<std::uint8_t>(random());
    ASSERT_FALSE(planner.restore(garbage));
  }
  EXPECT_EQ(planner.save(), untouched);
}

TEST(Checkpoint, AMapOfAnotherSizeIsRefused) {
  PathPlannerConfig small = planner_config();
  small.memory.cells = 80;
  PathPlanner other(small, 1);
  EXPECT_FALSE(other.restore(driven().planner.save()));
}

// Whatever a damaged byte changes: either it is refused, or the planner still works and publishes numbers.
TEST(Checkpoint, ADamagedByteNeverBringsThePlannerDown) {
  const PlannerRig rig = driven();
  const std::vector<std::uint8_t> bytes = rig.planner.save();
  std::mt19937_64 random(2);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<std::uint8_t> damaged = bytes;
    // Most of the bytes are the map's; half of the damage goes to what lies before it.
    const size_t at = i % 2 ? random() % 4000 : random() % bytes.size();
    damaged[at] = static_cast<std::uint8_t>(random());
    PlannerRig other = rig;
    other.planner = PathPlanner(planner_config(), 1);
    if (!other.planner.restore(damaged)) {
      ++refused;
      continue;
    }
    const PlannerOutput out = other.step();
    if (!out.path) continue;
    for (const RoutePoint& point : out.path->points)
      ASSERT_TRUE(std::isfinite(point.p.x_m) && std::isfinite(point.p.y_m)) << "byte " << at << " of damage " << i;
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace rover::planning
