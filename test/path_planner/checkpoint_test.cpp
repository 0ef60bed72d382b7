// What the planner saves it restores; bytes that are not a state change nothing.
#include <gtest/gtest.h>

#include <cstring>

#include "test/path_planner/planner_rig.hpp"

namespace rover::planning {
namespace {

using testing_support::planner_config;
using testing_support::PlannerRig;

constexpr std::int64_t kSecondBoot = 1'000'001;

// A drive that knows hazards and follows a plan around them.
const PlannerRig& driven() {
  static const PlannerRig rig = [] {
    PlannerRig out;
    out.send_path({{0.0, 0.0}, {20.0, 1.0}});
    out.rocks = {{{3.0, 0.1}, 0.25, 0.3}, {{3.0, 1.9}, 0.15, 0.3}};
    out.look(2);
    out.go(1.0);
    return out;
  }();
  return rig;
}

PathPlanner fresh_planner(std::int64_t first_path_id = 1) {
  return PathPlanner(planner_config(), first_path_id);
}

std::vector<Hazard> hazards_of(const PathPlanner& planner) {
  return Costmap({}, planner.belief(), position(driven().odom), 20.0).hazards();
}

// Without the next path id, which moves on with each restart.
std::vector<std::uint8_t> state_of(const PathPlanner& planner) {
  std::vector<std::uint8_t> bytes = planner.save();
  std::fill_n(bytes.begin() + sizeof(std::uint32_t), sizeof(std::int64_t), std::uint8_t{0});
  return bytes;
}

TEST(Checkpoint, ARestoredPlannerSavesTheSameState) {
  PathPlanner planner = fresh_planner();
  ASSERT_TRUE(planner.restore(driven().planner.save()));
  EXPECT_EQ(state_of(planner), state_of(driven().planner));
  PathPlanner empty = fresh_planner();
  ASSERT_TRUE(empty.restore(fresh_planner().save()));
  EXPECT_EQ(empty.save(), fresh_planner().save());
}

TEST(Checkpoint, ARestartedPlannerContinuesItsPathOnTheSameGround) {
  PlannerRig rig = driven();
  const LocalPath before = rig.paths.back();
  ASSERT_EQ(before.kind, PathKind::kRepair);
  const std::int32_t replans = rig.planner.step(rig.now).status.replans;
  PathPlanner restarted = fresh_planner(kSecondBoot);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  EXPECT_EQ(hazards_of(restarted).size(), hazards_of(rig.planner).size());
  rig.planner = restarted;
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path) << "its clients may have missed it";
  EXPECT_EQ(out.path->kind, before.kind);
  ASSERT_EQ(out.path->points.size(), before.points.size());
  for (size_t i = 0; i < before.points.size(); ++i) EXPECT_EQ(distance(out.path->points[i].p, before.points[i].p), 0.0);
  EXPECT_EQ(out.status.state, PlannerState::kRepairing);
  EXPECT_EQ(out.status.replans, replans);
  EXPECT_FALSE(rig.step().path) << "once is enough";
}

TEST(Checkpoint, ACorrectionDuringTheRestartMovesThePath) {
  PlannerRig rig = driven();
  PathPlanner restarted = fresh_planner(kSecondBoot);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  rig.planner = restarted;
  rig.T_map_odom = {0.0, -0.6, 0.0};
  rig.step();
  EXPECT_NEAR(rig.paths.back().points.back().p.y_m, 1.6, 0.05);
}

TEST(Checkpoint, ARestartedPlannerKnowsTheDrivenTrack) {
  PlannerRig rig = driven();
  PathPlanner restarted = fresh_planner(kSecondBoot);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  rig.planner = restarted;
  rig.look();
  rig.planner.request_back_up(true);
  rig.look(2);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kBacktrack);
}

TEST(Checkpoint, ARestartedPlannerKnowsFromHowNearGroundWasNotMeasured) {
  PlannerRig rig = driven();
  rig.camera.near_m = 1.6;
  rig.look(8);
  PathPlanner restarted = fresh_planner(kSecondBoot);
  ASSERT_TRUE(restarted.restore(rig.planner.save()));
  int unmeasured = 0;
  rig.planner.belief().cells().for_each([&](CellIndex i, const CellBelief& cell) {
    if (cell.unmeasured == 0) return;
    ++unmeasured;
    ASSERT_EQ(restarted.belief().cells().get(i).unmeasured, cell.unmeasured);
    ASSERT_EQ(restarted.belief().cells().get(i).unmeasured_range_m, cell.unmeasured_range_m);
  });
  EXPECT_GT(unmeasured, 10);
}

TEST(Checkpoint, PathIdsAreNotUsedAgainAfterARestart) {
  for (const std::int64_t first_id : {std::int64_t{1}, kSecondBoot}) {
    PlannerRig rig = driven();
    std::int64_t last = rig.paths.back().id;
    PathPlanner restarted = fresh_planner(first_id);
    ASSERT_TRUE(restarted.restore(rig.planner.save()));
    rig.planner = restarted;
    const size_t before = rig.paths.size();
    rig.look();
    rig.send_path({{0.0, 0.0}, {20.0, 0.0}}, 8);
    rig.look(2);
    ASSERT_GT(rig.paths.size(), before);
    for (size_t i = before; i < rig.paths.size(); ++i) {
      EXPECT_GT(rig.paths[i].id, last);
      EXPECT_GE(rig.paths[i].id, first_id);
      last = rig.paths[i].id;
    }
  }
}

TEST(Checkpoint, TruncatedAndLengthenedBytesAreRefused) {
  const std::vector<std::uint8_t> bytes = driven().planner.save();
  PathPlanner planner = fresh_planner();
  const std::vector<std::uint8_t> untouched = planner.save();
  for (size_t size = 0; size < bytes.size(); size += size < 500 ? 1 : 9973)
    ASSERT_FALSE(planner.restore({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(planner.restore(longer));
  EXPECT_EQ(planner.save(), untouched);
}

TEST(Checkpoint, RandomBytesAreRefused) {
  std::mt19937_64 random(1);
  PathPlanner planner = fresh_planner();
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
  small.belief.cells = 80;
  PathPlanner planner(small, 1);
  EXPECT_FALSE(planner.restore(driven().planner.save()));
}

// Damaged bytes are refused, or the planner still publishes numbers.
bool survives(const std::vector<std::uint8_t>& damaged) {
  PlannerRig rig = driven();
  rig.planner = fresh_planner();
  const std::vector<std::uint8_t> untouched = rig.planner.save();
  if (!rig.planner.restore(damaged)) return rig.planner.save() == untouched;
  const PlannerOutput out = rig.step();
  rig.look();
  const auto is_number = [](const RoutePoint& point) {
    return std::isfinite(point.p.x_m) && std::isfinite(point.p.y_m);
  };
  return !out.path || (out.path->corridor_half_width_m > 0.0 && out.path->kind >= PathKind::kGlobal &&
                       out.path->kind <= PathKind::kContinuous &&
                       std::all_of(out.path->points.begin(), out.path->points.end(), is_number));
}

TEST(Checkpoint, ADamagedByteNeverStopsThePlanner) {
  const std::vector<std::uint8_t> bytes = driven().planner.save();
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> damaged = bytes;
    // Most bytes are the map's; half of the damage goes to those before it.
    const size_t at = i % 2 ? random() % 4000 : random() % bytes.size();
    damaged[at] = static_cast<std::uint8_t>(random());
    EXPECT_TRUE(survives(damaged)) << "byte " << at;
  }
}

TEST(Checkpoint, ADamagedNumberNeverStopsThePlanner) {
  const std::vector<std::uint8_t> bytes = driven().planner.save();
  for (const double number : {kNaN, kInfinity, -1e300})
    for (size_t at = 4; at < 4000; at += at < 160 ? 1 : 137) {
      std::vector<std::uint8_t> damaged = bytes;
      std::memcpy(damaged.data() + at, &number, sizeof(number));
      EXPECT_TRUE(survives(damaged)) << "byte " << at << ": " << number;
    }
}

}  // namespace
}  // namespace rover::planning
