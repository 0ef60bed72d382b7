#include "common/core/lease.hpp"

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

TEST(Lease, FreshPermitAndCommandAreValid) {
  EXPECT_TRUE(permit_valid(permit(), kNow, kAge));
  EXPECT_TRUE(command_valid(command(), kNow, kAge));
}

TEST(Lease, NothingReceivedIsInvalid) {
  EXPECT_FALSE(permit_valid(DrivePermit{}, kNow, kAge));
  EXPECT_FALSE(command_valid(MotionCommand{}, kNow, kAge));
  EXPECT_FALSE(permit_valid(DrivePermit{}, 0, kAge));
  EXPECT_FALSE(command_valid(MotionCommand{}, 0, kAge));
}

TEST(Lease, ExpiresAtValidUntil) {
  EXPECT_TRUE(permit_valid(permit(), kNow + 180'000, kAge));
  EXPECT_FALSE(permit_valid(permit(), kNow + 180'001, kAge));
  EXPECT_FALSE(command_valid(command(), kNow + 180'001, kAge));
}

TEST(Lease, PublisherCannotExtendItBeyondMaxAge) {
  DrivePermit overlong = permit();
  overlong.valid_until = kNow + 60'000'000;
  EXPECT_TRUE(permit_valid(overlong, kNow, kAge));
  EXPECT_FALSE(permit_valid(overlong, kNow + 200'000, kAge));
}

TEST(Lease, MessagesFromTheFutureAreInvalid) {
  DrivePermit future = permit();
  future.utime = kNow + 1;
  EXPECT_FALSE(permit_valid(future, kNow, kAge));
}

TEST(Lease, WithdrawnPermitIsInvalid) {
  DrivePermit refused = permit();
  refused.granted = false;
  EXPECT_FALSE(permit_valid(refused, kNow, kAge));
  DrivePermit ended = permit();
  ended.utime = ended.valid_until = kNow;  // valid_until == utime means withdrawn
  EXPECT_FALSE(permit_valid(ended, kNow, kAge));
}

TEST(Lease, NanAndInfinityAreInvalid) {
  DrivePermit p = permit();
  p.max_speed_mps = kNaN;
  EXPECT_FALSE(permit_valid(p, kNow, kAge));
  for (double MotionCommand::*field :
       {&MotionCommand::speed_mps, &MotionCommand::curvature_per_m, &MotionCommand::turn_rate_radps}) {
    MotionCommand c = command();
    c.*field = kNaN;
    EXPECT_FALSE(command_valid(c, kNow, kAge));
    c.*field = kInfinity;
    EXPECT_FALSE(command_valid(c, kNow, kAge));
  }
}

}  // namespace
}  // namespace rover::locomotion
