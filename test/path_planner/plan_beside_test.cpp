#include "path_planner/plan_beside.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "path_planner/path_planner.hpp"
#include "test/path_planner/rock_world.hpp"

namespace rover::planning {
namespace {

using testing_support::planner_config;

constexpr Utime kLatency = 200'000;
constexpr Utime kPatience = 60'000'000;

// Over ground of which nothing is known there is no plan, which is found at once.
std::shared_ptr<const PlanJob> job() {
  const PathPlannerConfig config = planner_config();
  const Route ahead({{{0.0, 0.0}}, {{30.0, 0.0}}});
  auto out = std::make_shared<PlanJob>(config.full, HazardMemory(config.memory),
                                       GroundMap(config.full.map_cells, config.memory.cell_m, 3.0), ahead,
                                       std::vector<DeadEnd>{});
  out->request().footprint = config.footprint;
  out->request().view = config.repair.view;
  return out;
}

TEST(PlanBeside, InLockstepAPlanComesAtItsTimeHoweverLongItTook) {
  PlanBeside maker({kLatency, kPatience}, [] { return false; });
  EXPECT_FALSE(maker.result(0, false));
  ASSERT_TRUE(maker.start(job(), 1'000'000));
  EXPECT_FALSE(maker.result(1'000'000 + kLatency - 20'000, false));
  EXPECT_TRUE(maker.result(1'000'000 + kLatency, false));
  EXPECT_FALSE(maker.result(1'000'000 + kLatency, false));
}

TEST(PlanBeside, InLockstepANewJobTakesThePlaceOfTheOldOne) {
  PlanBeside maker({kLatency, kPatience}, [] { return false; });
  ASSERT_TRUE(maker.start(job(), 1'000'000));
  ASSERT_TRUE(maker.start(job(), 1'100'000));
  EXPECT_FALSE(maker.result(1'000'000 + kLatency, false));
  EXPECT_TRUE(maker.result(1'100'000 + kLatency, false));
}

TEST(PlanBeside, ByTheClockItComesWhenItIsThere) {
  PlanBeside maker({kLatency, kPatience}, [] { return true; });
  ASSERT_TRUE(maker.start(job(), 1'000'000));
  while (!maker.start(job(), 2'000'000)) std::this_thread::yield();  // at work for nobody
  EXPECT_FALSE(maker.result(2'000'000 + kLatency - 20'000, false));
  while (!maker.result(2'000'000 + kLatency, false)) std::this_thread::yield();
  EXPECT_FALSE(maker.result(3'000'000, false));
}

TEST(PlanBeside, InLockstepAPressingPlanIsThereAtOnceIfItsWorkIsDoneWithinThePatience) {
  PlanBeside maker({kLatency, kPatience}, [] { return false; });
  ASSERT_TRUE(maker.start(job(), 1'000'000));
  EXPECT_TRUE(maker.result(1'000'000, true));
  EXPECT_FALSE(maker.result(1'000'000 + kLatency, true));
}

TEST(PlanBeside, InLockstepAPressingPlanThatTakesLongerComesAtItsTime) {
  const std::shared_ptr<const PlanJob> slow = job();
  const Utime work = to_utime(slow->run().work_s);
  ASSERT_GT(work, 20'000);
  PlanBeside maker({kLatency, work - 10'000}, [] { return false; });
  ASSERT_TRUE(maker.start(slow, 1'000'000));
  EXPECT_FALSE(maker.result(1'000'000, true));
  EXPECT_TRUE(maker.result(1'000'000 + kLatency, true));
}

TEST(PlanBeside, ByTheClockAPressingPlanIsWaitedFor) {
  PlanBeside maker({kLatency, kPatience}, [] { return true; });
  ASSERT_TRUE(maker.start(job(), 1'000'000));
  EXPECT_TRUE(maker.result(1'000'000, true));
}

}  // namespace
}  // namespace rover::planning
