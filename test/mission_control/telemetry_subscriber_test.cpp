// Subscriptions exist only while a page is open; TRUTH only while a page shows it.
#include "mission_control/telemetry_subscriber.hpp"

#include <gtest/gtest.h>

#include "common/bus/channels.hpp"

namespace rover::mission {
namespace {

class TelemetrySubscriberTest : public testing::Test {
 protected:
  void say(double wall_s = 0.0) {
    subscriber_.update(wall_s);
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
  Utime newest_tick() {
    return subscriber_.with([](TelemetryStore& g) { return g.view(0.0).now; });
  }
  Utime truth() {
    return subscriber_.with([](TelemetryStore& g) { return g.truth().utime; });
  }

  lcm::LCM bus_{"memq://"};
  PageClients clients_;
  TelemetrySubscriber subscriber_{bus_, clients_, {"stereo"}};
  Utime time_ = 0;
};

TEST_F(TelemetrySubscriberTest, DoesNotSubscribeWithoutPage) {
  say();
  EXPECT_FALSE(subscriber_.subscribed());
  EXPECT_EQ(newest_tick(), kNever);
}

TEST_F(TelemetrySubscriberTest, DoesNotSubscribeToTruthByDefault) {
  ASSERT_TRUE(clients_.connect(false, 4));
  say();
  EXPECT_EQ(newest_tick(), 1);
  EXPECT_EQ(truth(), kNever);
}

TEST_F(TelemetrySubscriberTest, SubscribesToTruthWhileAPageShowsIt) {
  ASSERT_TRUE(clients_.connect(true, 4));
  say();
  EXPECT_EQ(truth(), 1);
  ASSERT_TRUE(clients_.connect(false, 4));
  clients_.disconnect(true);
  say();
  EXPECT_EQ(newest_tick(), 2);
  EXPECT_EQ(truth(), 1) << "nobody asks any more";
}

TEST_F(TelemetrySubscriberTest, UnsubscribesAndResetsAfterLastPageCloses) {
  ASSERT_TRUE(clients_.connect(false, 4));
  say(0.0);
  clients_.disconnect(false);
  say(1.0);
  EXPECT_EQ(newest_tick(), 2) << "the page may only be loaded anew";
  say(10.0);
  EXPECT_FALSE(subscriber_.subscribed());
  EXPECT_EQ(newest_tick(), kNever);
}

TEST_F(TelemetrySubscriberTest, NumberOfPagesIsLimited) {
  EXPECT_TRUE(clients_.connect(false, 2));
  EXPECT_TRUE(clients_.connect(true, 2));
  EXPECT_FALSE(clients_.connect(false, 2));
  clients_.disconnect(true);
  EXPECT_TRUE(clients_.connect(false, 2));
}

}  // namespace
}  // namespace rover::mission
