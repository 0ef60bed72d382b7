#include "recorder/keep_policy.hpp"

#include <gtest/gtest.h>

namespace rover::recorder {
namespace {

constexpr Utime kSecond = 1'000'000;

Event image(Utime utime, std::int64_t seq) {
  Event e;
  e.utime = utime;
  e.release = utime + 60'000;
  e.channel = "LOCCAM_LEFT";
  e.seq = seq;
  return e;
}

KeepConfig reduced() {
  KeepConfig config;
  config.reduced = true;
  config.images_before_s = 2.0;
  config.images_after_s = 1.0;
  config.image_interval = 50;
  config.bulk_channels = {"LOCCAM_LEFT"};
  return config;
}

TEST(KeepPolicy, FullKeepsAllEventsWithoutDelay) {
  KeepConfig config = reduced();
  config.reduced = false;
  const KeepPolicy policy(config);
  EXPECT_TRUE(policy.keep(image(3 * kSecond, 7)));
  EXPECT_EQ(policy.delay(), 0);
}

TEST(KeepPolicy, ReducedKeepsImagesAroundTriggers) {
  KeepPolicy policy(reduced());
  policy.trigger(10 * kSecond);
  EXPECT_FALSE(policy.keep(image(8 * kSecond - 1, 2)));
  EXPECT_TRUE(policy.keep(image(8 * kSecond, 3)));
  EXPECT_TRUE(policy.keep(image(11 * kSecond, 4)));
  EXPECT_FALSE(policy.keep(image(11 * kSecond + 1, 5)));
}

TEST(KeepPolicy, ReducedKeepsEvery50thImageAndAllOtherMessages) {
  const KeepPolicy policy(reduced());
  EXPECT_TRUE(policy.keep(image(0, 1)));
  EXPECT_FALSE(policy.keep(image(0, 2)));
  EXPECT_FALSE(policy.keep(image(0, 50)));
  EXPECT_TRUE(policy.keep(image(0, 51)));
  Event pose = image(0, 2);
  pose.channel = "POSE";
  EXPECT_TRUE(policy.keep(pose));
}

TEST(KeepPolicy, DelaysEventsUntilLaterTriggersAreKnown) {
  EXPECT_EQ(KeepPolicy(reduced()).delay(), 2 * kSecond);
}

TEST(KeepPolicy, OldTriggersAreDropped) {
  KeepPolicy policy(reduced());
  policy.trigger(0);
  policy.trigger(100 * kSecond);
  EXPECT_FALSE(policy.keep(image(0, 2)));
  EXPECT_TRUE(policy.keep(image(100 * kSecond, 2)));
}

}  // namespace
}  // namespace rover::recorder
