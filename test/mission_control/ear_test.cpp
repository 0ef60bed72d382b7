// The ear listens while a page is open, and to the true world only while a page asks for it.
#include "mission_control/ear.hpp"

#include <gtest/gtest.h>

#include "common/bus/channels.hpp"

namespace rover::mission {
namespace {

class EarTest : public testing::Test {
 protected:
  void say(double wall_s = 0.0) {
    ear_.attend(wall_s);
    truth_t truth{};
    truth.header.utime = ++time_;
    truth.quat_map_body_wxyz[0] = 1.0;
    bus_.publish(channel::kTruth, &truth);
    tick_t tick{};
    tick.header.utime = time_;
    bus_.publish(channel::kTick, &tick);
    while (bus_.handleTimeout(0) > 0) {
    }
  }
  Utime heard() {
    return ear_.with([](Gatherer& g) { return g.view(0.0).now; });
  }
  Utime truth() {
    return ear_.with([](Gatherer& g) { return g.truth().utime; });
  }

  lcm::LCM bus_{"memq://"};
  Audience audience_;
  Ear ear_{bus_, audience_, {"stereo"}};
  Utime time_ = 0;
};

TEST_F(EarTest, WithoutAPageNothingIsHeard) {
  say();
  EXPECT_FALSE(ear_.listening());
  EXPECT_EQ(heard(), kNever);
}

TEST_F(EarTest, WithAPageTheTrueWorldIsNotHeard) {
  ASSERT_TRUE(audience_.enter(false, 4));
  say();
  EXPECT_EQ(heard(), 1);
  EXPECT_EQ(truth(), kNever);
}

TEST_F(EarTest, TheTrueWorldIsHeardAsLongAsAPageAsks) {
  ASSERT_TRUE(audience_.enter(true, 4));
  say();
  EXPECT_EQ(truth(), 1);
  ASSERT_TRUE(audience_.enter(false, 4));
  audience_.leave(true);
  say();
  EXPECT_EQ(heard(), 2);
  EXPECT_EQ(truth(), 1) << "nobody asks any more";
}

TEST_F(EarTest, ItEndsSomeSecondsAfterTheLastPageAndForgets) {
  ASSERT_TRUE(audience_.enter(false, 4));
  say(0.0);
  audience_.leave(false);
  say(1.0);
  EXPECT_EQ(heard(), 2) << "the page may only be loaded anew";
  say(10.0);
  EXPECT_FALSE(ear_.listening());
  EXPECT_EQ(heard(), kNever);
}

TEST_F(EarTest, NoMorePagesThanMayCome) {
  EXPECT_TRUE(audience_.enter(false, 2));
  EXPECT_TRUE(audience_.enter(true, 2));
  EXPECT_FALSE(audience_.enter(false, 2));
  audience_.leave(true);
  EXPECT_TRUE(audience_.enter(false, 2));
}

}  // namespace
}  // namespace rover::mission
