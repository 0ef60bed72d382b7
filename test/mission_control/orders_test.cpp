// The orders of a plan: in their sequence, each until it is accepted, none twice.
#include "mission_control/orders.hpp"

#include <gtest/gtest.h>

namespace rover {
namespace {

TEST(Orders, ComeOneAfterTheOtherAndEnd) {
  Orders orders;
  const auto first = orders.step(0, false, 7);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->order, Order::kStartPose);
  EXPECT_EQ(first->command_id, 7);
  EXPECT_FALSE(orders.step(20'000, false, 8));  // waits for its answer
  EXPECT_TRUE(orders.acknowledge(7, true, ""));
  EXPECT_EQ(orders.step(40'000, false, 8)->order, Order::kPath);
  EXPECT_TRUE(orders.acknowledge(8, true, ""));
  EXPECT_FALSE(orders.step(60'000, false, 9));  // not before STANDBY
  EXPECT_EQ(orders.step(80'000, true, 9)->order, Order::kGo);
  EXPECT_TRUE(orders.acknowledge(9, true, ""));
  EXPECT_TRUE(orders.all_accepted());
  EXPECT_FALSE(orders.step(10'000'000, true, 10));
}

TEST(Orders, ARefusedOneIsTriedAgainASecondLater) {
  Orders orders;
  orders.step(0, false, 1);
  EXPECT_TRUE(orders.acknowledge(1, false, "not level yet"));
  EXPECT_EQ(orders.refusal(), "not level yet");
  EXPECT_FALSE(orders.step(900'000, false, 2));
  EXPECT_TRUE(orders.step(1'000'000, false, 2));
  EXPECT_FALSE(orders.acknowledge(1, true, "")) << "an answer to another command";
  EXPECT_TRUE(orders.acknowledge(2, true, ""));
  EXPECT_EQ(orders.refusal(), "");
}

TEST(Orders, ARestartDoesNotGiveThemAgain) {
  for (int progress = 0; progress <= 3; ++progress) {
    Orders orders;
    orders.resume_at(progress);
    EXPECT_EQ(orders.progress(), progress);
    const auto next = orders.step(0, true, 1);
    EXPECT_EQ(next.has_value(), progress < 3);
    if (next) {
      EXPECT_EQ(static_cast<int>(next->order), progress);
    }
  }
  Orders orders;
  orders.resume_at(99);
  EXPECT_EQ(orders.progress(), 0);
}

TEST(Orders, AbandonedOnesAreNotGiven) {
  Orders orders;
  orders.step(0, true, 1);
  orders.abandon();
  EXPECT_FALSE(orders.step(5'000'000, true, 2));
  EXPECT_FALSE(orders.acknowledge(1, true, ""));
}

}  // namespace
}  // namespace rover
