#include "tools/replay/pacer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rover::replay {
namespace {

TEST(Pacer, FollowsClockAtPlaybackSpeed) {
  Pacer pacer(2.0);
  pacer.go_from(1'000'000, 50.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(1'000'000, 50.0), 0.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(3'000'000, 50.0), 1.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(3'000'000, 50.75), 0.25);
  EXPECT_DOUBLE_EQ(pacer.wait_s(3'000'000, 52.0), 0.0);  // late: due at once
}

TEST(Pacer, MessageTimeStopsDuringPause) {
  Pacer pacer(1.0);
  pacer.go_from(0, 0.0);
  pacer.pause(1.0);
  EXPECT_TRUE(std::isinf(pacer.wait_s(1'500'000, 5.0)));
  pacer.resume(10.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(1'500'000, 10.0), 0.5);
}

TEST(Pacer, SpeedChangeCausesNoJump) {
  Pacer pacer(1.0);
  pacer.go_from(0, 0.0);
  pacer.set_speed(4.0, 2.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(2'000'000, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(6'000'000, 2.0), 1.0);
}

TEST(Pacer, SpeedZeroNeverWaits) {
  Pacer pacer(0.0);
  pacer.go_from(0, 0.0);
  EXPECT_DOUBLE_EQ(pacer.wait_s(3'600'000'000, 0.0), 0.0);
}

}  // namespace
}  // namespace rover::replay
