// When a plan of the background thread is handed over, in lockstep and by the clock.
#include "path_planner/background_thread.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace rover::planning {
namespace {

constexpr Utime kLatency = 200'000;
constexpr Utime kStart = 1'000'000;

// A job that makes a plan of this cost.
PlanJob job_of(double cost) {
  return [cost] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    Plan plan;
    plan.cost = cost;
    return plan;
  };
}

TEST(BackgroundThread, InLockstepAPlanComesAfterTheLatencyHoweverLongItTook) {
  BackgroundThread background(kLatency, [] { return false; });
  EXPECT_FALSE(background.result(0));
  ASSERT_TRUE(background.start(job_of(1.0), kStart));
  EXPECT_FALSE(background.result(kStart + kLatency - 20'000));
  EXPECT_EQ(background.result(kStart + kLatency).value().cost, 1.0);
  EXPECT_FALSE(background.result(kStart + kLatency));
}

TEST(BackgroundThread, InLockstepANewJobReplacesTheOldOne) {
  BackgroundThread background(kLatency, [] { return false; });
  ASSERT_TRUE(background.start(job_of(1.0), kStart));
  ASSERT_TRUE(background.start(job_of(2.0), kStart + 100'000));
  EXPECT_FALSE(background.result(kStart + kLatency));
  EXPECT_EQ(background.result(kStart + 100'000 + kLatency).value().cost, 2.0);
}

TEST(BackgroundThread, ByTheClockAPlanComesWhenItIsReadyAndARunningJobIsNotReplaced) {
  BackgroundThread background(kLatency, [] { return true; });
  std::promise<void> go;
  ASSERT_TRUE(background.start(
      [&go] {
        go.get_future().wait();
        return Plan{};
      },
      kStart));
  EXPECT_FALSE(background.result(kStart + 2 * kLatency));
  EXPECT_FALSE(background.start(job_of(2.0), kStart));
  go.set_value();
  while (!background.start(job_of(3.0), kStart)) std::this_thread::yield();
  std::optional<Plan> plan;
  while (!plan) plan = background.result(kStart + kLatency);
  EXPECT_EQ(plan->cost, 3.0);
  EXPECT_FALSE(background.result(kStart + 2 * kLatency));
}

}  // namespace
}  // namespace rover::planning
