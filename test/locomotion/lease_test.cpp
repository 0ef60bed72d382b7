#include "locomotion/lease.hpp"

#include <gtest/gtest.h>

#include "common/core/frames.hpp"

namespace rover::locomotion {
namespace {

constexpr Utime kNow = 10'000'000;
constexpr Utime kAge = 200'000;

DrivePermit permit() {
  return {kNow - 20'000, kNow + 180'000, true, 0.2};
}
MotionCommand command() {
  return {kNow - 20'000, kNow + 180'000, MotionMode::kArc, 0.1, 0.0, 0.0};
}

TEST(Lease, HoldsWhileFresh) {
  EXPECT_TRUE(permits(permit(), kNow, kAge));
  EXPECT_TRUE(commands(command(), kNow, kAge));
}

TEST(Lease, NothingReceivedIsNoLease) {
  EXPECT_FALSE(permits(DrivePermit{}, kNow, kAge));
  EXPECT_FALSE(commands(MotionCommand{}, kNow, kAge));
  EXPECT_FALSE(permits(DrivePermit{}, 0, kAge));
  EXPECT_FALSE(commands(MotionCommand{}, 0, kAge));
}

TEST(Lease, EndsAtItsTime) {
  EXPECT_TRUE(permits(permit(), kNow + 180'000, kAge));
  EXPECT_FALSE(permits(permit(), kNow + 180'001, kAge));
  EXPECT_FALSE(commands(command(), kNow + 180'001, kAge));
}

TEST(Lease, AnAuthorCannotMakeItLonger) {
  DrivePermit greedy = permit();
  greedy.valid_until = kNow + 60'000'000;
  EXPECT_TRUE(permits(greedy, kNow, kAge));
  EXPECT_FALSE(permits(greedy, kNow + 200'000, kAge));
}

TEST(Lease, MessagesFromTheFutureAreNotBelieved) {
  DrivePermit early = permit();
  early.utime = kNow + 1;
  EXPECT_FALSE(permits(early, kNow, kAge));
}

TEST(Lease, WithdrawnIsWithdrawn) {
  DrivePermit refused = permit();
  refused.granted = false;
  EXPECT_FALSE(permits(refused, kNow, kAge));
  DrivePermit ended = permit();
  ended.utime = ended.valid_until = kNow;  // not after header.utime: withdrawn
  EXPECT_FALSE(permits(ended, kNow, kAge));
}

TEST(Lease, NotANumberIsNoLease) {
  DrivePermit p = permit();
  p.max_speed_mps = kNaN;
  EXPECT_FALSE(permits(p, kNow, kAge));
  for (double MotionCommand::*field :
       {&MotionCommand::speed_mps, &MotionCommand::curvature_per_m, &MotionCommand::turn_rate_radps}) {
    MotionCommand c = command();
    c.*field = kNaN;
    EXPECT_FALSE(commands(c, kNow, kAge));
    c.*field = kInfinity;
    EXPECT_FALSE(commands(c, kNow, kAge));
  }
}

}  // namespace
}  // namespace rover::locomotion
