#include "common/core/barrier.hpp"

#include <gtest/gtest.h>

namespace rover {
namespace {

using Names = std::vector<std::string>;

// One participant that has done its tick at 0.
class BarrierTest : public testing::Test {
 protected:
  BarrierTest() : barrier_({"node"}) {
    barrier_.ready("node", 5, 100);
    barrier_.admit(0);
    barrier_.done("node", 5, 100, 0, kNever);
  }
  bool waits_at(Utime t) const { return !barrier_.waiting_for(t).empty(); }

  Barrier barrier_;
};

TEST_F(BarrierTest, WaitsForDoneUnlessPromised) {
  EXPECT_FALSE(waits_at(kTickUs));
  EXPECT_TRUE(waits_at(2 * kTickUs));
  barrier_.done("node", 5, 100, kTickUs, 10 * kTickUs);
  EXPECT_FALSE(waits_at(9 * kTickUs));
  EXPECT_TRUE(waits_at(10 * kTickUs));
}

TEST_F(BarrierTest, DeadProcessRejoinsOnlyWithNewerBootId) {
  barrier_.leave("node", Barrier::Cause::kDied, 2 * kTickUs, 10 * kTickUs);
  EXPECT_TRUE(barrier_.admit(3 * kTickUs).empty());
  EXPECT_FALSE(waits_at(6 * kTickUs));
  EXPECT_TRUE(waits_at(7 * kTickUs));
  barrier_.done("node", 5, 100, kTickUs, kNever);  // its last words
  EXPECT_TRUE(waits_at(12 * kTickUs));
  barrier_.ready("node", 6, 101);
  EXPECT_EQ(barrier_.pid_of("node"), 101);
  EXPECT_TRUE(barrier_.admit(11 * kTickUs).empty());
  EXPECT_EQ(barrier_.admit(12 * kTickUs), Names{"node"});
}

TEST_F(BarrierTest, StoppedParticipantReturnsWhenItIsExpected) {
  barrier_.stop("node");
  EXPECT_FALSE(waits_at(1'000 * kTickUs));
  barrier_.ready("node", 6, 101);
  EXPECT_TRUE(barrier_.admit(1'000 * kTickUs).empty());
  barrier_.expect("node", 1'000 * kTickUs, 10 * kTickUs);
  EXPECT_TRUE(barrier_.admit(1'009 * kTickUs).empty());
  EXPECT_EQ(barrier_.admit(1'010 * kTickUs), Names{"node"});
}

TEST_F(BarrierTest, TicksWaitForAnExpectedParticipant) {
  barrier_.stop("node");
  barrier_.expect("node", 1'000 * kTickUs, 10 * kTickUs);
  EXPECT_FALSE(waits_at(1'004 * kTickUs));
  EXPECT_TRUE(waits_at(1'005 * kTickUs));
  barrier_.ready("node", 6, 101);
  EXPECT_FALSE(waits_at(1'005 * kTickUs));
}

TEST_F(BarrierTest, IsIdleOnlyAfterFinalReportOfTick) {
  EXPECT_TRUE(barrier_.idle("node"));
  barrier_.admit(kTickUs);
  EXPECT_FALSE(barrier_.idle("node"));
  barrier_.done("node", 5, 100, kTickUs, 6 * kTickUs, true);
  EXPECT_FALSE(waits_at(5 * kTickUs));
  EXPECT_FALSE(barrier_.idle("node"));
  barrier_.done("node", 5, 100, kTickUs, 6 * kTickUs);
  EXPECT_TRUE(barrier_.idle("node"));
}

TEST_F(BarrierTest, TimeJumpsOnlyForIdleServices) {
  barrier_.allow_until(100 * kTickUs);
  EXPECT_FALSE(waits_at(100 * kTickUs));
  EXPECT_EQ(barrier_.admit(100 * kTickUs), Names{"node"});
  barrier_.done("node", 5, 100, 100 * kTickUs, 106 * kTickUs, true);
  barrier_.allow_until(200 * kTickUs);
  EXPECT_TRUE(waits_at(200 * kTickUs));
}

TEST_F(BarrierTest, GivenUpProcessIsNotWaitedForAndMayRejoin) {
  barrier_.leave("node", Barrier::Cause::kDied, 2 * kTickUs, 10 * kTickUs);
  barrier_.give_up("node");
  EXPECT_FALSE(waits_at(100 * kTickUs));
  EXPECT_FALSE(barrier_.takes_part("node"));
  barrier_.ready("node", 6, 101);
  EXPECT_EQ(barrier_.admit(100 * kTickUs), Names{"node"});
}

TEST_F(BarrierTest, SilentProcessRejoinsWithItsNextReport) {
  barrier_.leave("node", Barrier::Cause::kSilent, 2 * kTickUs, 10 * kTickUs);
  EXPECT_EQ(barrier_.pid_of("node"), 100);
  EXPECT_TRUE(waits_at(12 * kTickUs));
  barrier_.done("node", 5, 100, kTickUs, kNever);
  EXPECT_TRUE(barrier_.admit(11 * kTickUs).empty());
  EXPECT_FALSE(waits_at(12 * kTickUs));
  EXPECT_EQ(barrier_.admit(12 * kTickUs), Names{"node"});
  EXPECT_TRUE(waits_at(13 * kTickUs));
  barrier_.done("node", 5, 100, 12 * kTickUs, kNever);
  EXPECT_FALSE(waits_at(13 * kTickUs));
}

// s6 restarts a process within 0.15 s; the barrier notices the death only when a report is due.
TEST_F(BarrierTest, ProcessRestartedBeforeItsDeathIsNoticedRejoins) {
  barrier_.done("node", 5, 100, 0, 10 * kTickUs);
  barrier_.ready("node", 6, 101);
  barrier_.admit(kTickUs);
  barrier_.done("node", 6, 101, kTickUs, 20 * kTickUs);  // it took its predecessor's tick
  EXPECT_EQ(barrier_.pid_of("node"), 100);
  EXPECT_TRUE(waits_at(10 * kTickUs));
  barrier_.leave("node", Barrier::Cause::kDied, 10 * kTickUs, 10 * kTickUs);
  EXPECT_EQ(barrier_.pid_of("node"), 101);
  EXPECT_TRUE(barrier_.admit(19 * kTickUs).empty());
  EXPECT_FALSE(waits_at(20 * kTickUs));
  EXPECT_EQ(barrier_.admit(20 * kTickUs), Names{"node"});
}

TEST_F(BarrierTest, ReplacedSilentProcessRejoinsAsNewProcess) {
  barrier_.leave("node", Barrier::Cause::kSilent, 2 * kTickUs, 10 * kTickUs);
  barrier_.done("node", 5, 100, kTickUs, kNever);
  barrier_.ready("node", 6, 101);
  EXPECT_EQ(barrier_.admit(12 * kTickUs), Names{"node"});
  EXPECT_EQ(barrier_.pid_of("node"), 101);
  barrier_.done("node", 5, 100, 12 * kTickUs, kNever);  // reports of the old process are ignored
  EXPECT_TRUE(waits_at(14 * kTickUs));
}

}  // namespace
}  // namespace rover
