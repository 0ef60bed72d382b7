#include "tools/launcher/bus_lock.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdlib>

namespace rover {
namespace {

const std::string kBus = "udpm://239.255.76.67:55501?ttl=0";

TEST(BusLockTest, IsHeldOnce) {
  {
    const BusLock first(kBus);
    EXPECT_TRUE(first.held());
    EXPECT_FALSE(BusLock(kBus + "&recv_buf_size=4194304").held());
    EXPECT_TRUE(BusLock("udpm://239.255.76.67:55502?ttl=0").held());
  }
  EXPECT_TRUE(BusLock(kBus).held());
}

// A container with a network of its own, but this /tmp.
TEST(BusLockTest, AnotherNetworkHasItsOwnBuses) {
  const BusLock here(kBus);
  const auto held_there = [] { return unshare(CLONE_NEWNET) != 0 || BusLock(kBus).held() ? 0 : 1; };
  EXPECT_EXIT(std::_Exit(held_there()), testing::ExitedWithCode(0), "");
}

TEST(BusSlotTest, SkipsBusesThatAreInUse) {
  const BusSlot first;
  const BusSlot second;
  EXPECT_NE(first.url(), second.url());
  std::string next;
  {
    const BusSlot third;
    next = third.url();
  }
  const BusLock chosen_with_bus(next);
  EXPECT_NE(BusSlot().url(), next);
}

}  // namespace
}  // namespace rover
