#include "common/bus/fault_injector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <rover/pose_t.hpp>
#include <rover/slip_t.hpp>

#include "common/bus/streams.hpp"

namespace rover {
namespace {

using Bytes = FaultInjector::Bytes;

slip_t slip(std::int64_t seq, Utime utime, double value = 1.0) {
  slip_t message{};
  message.header.seq = seq;
  message.header.utime = utime;
  message.header.publisher = "localization";
  message.wheel_mps = value;
  return message;
}

injection_t injection(const std::string& fault, double amount, const std::string& target = "SLIP") {
  injection_t what{};
  what.target = target;
  what.fault = fault;
  what.amount = amount;
  what.from_utime = 100;
  what.until_utime = 200;
  return what;
}

std::vector<FaultInjector::Output> pass(FaultInjector& injector, const slip_t& message) {
  return injector.apply("SLIP", message.header, encoded(message));
}

slip_t decoded(const Bytes& bytes) {
  slip_t message{};
  EXPECT_TRUE(decode_message(bytes.data(), static_cast<int>(bytes.size()), message));
  return message;
}

// Number of copies and delay of messages 1..n at time 150.
std::vector<std::pair<size_t, Utime>> outcomes(const std::string& node, const injection_t& what, int n) {
  FaultInjector injector(node);
  EXPECT_TRUE(injector.inject(what));
  std::vector<std::pair<size_t, Utime>> out;
  for (int i = 1; i <= n; ++i) {
    const auto passed = pass(injector, slip(i, 150));
    out.emplace_back(passed.size(), passed.empty() ? 0 : passed.front().delay);
  }
  return out;
}

int lost(const std::vector<std::pair<size_t, Utime>>& outcomes) {
  return static_cast<int>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const auto& outcome) { return outcome.first == 0; }));
}

TEST(FaultInjector, MessagesOutsideOfTheTimeAreUnchanged) {
  FaultInjector injector("node");
  ASSERT_TRUE(injector.inject(injection("drop", 1.0)));
  EXPECT_EQ(pass(injector, slip(1, 99)).size(), 1u);
  EXPECT_EQ(pass(injector, slip(2, 150)).size(), 0u);
  EXPECT_EQ(pass(injector, slip(3, 201)).size(), 1u);
}

TEST(FaultInjector, DropsTheFractionReproduciblyAndDifferentlyPerNode) {
  const auto once = outcomes("node", injection("drop", 0.3), 1000);
  EXPECT_NEAR(lost(once), 300, 60);
  EXPECT_EQ(once, outcomes("node", injection("drop", 0.3), 1000));
  EXPECT_NE(once, outcomes("other", injection("drop", 0.3), 1000));
}

TEST(FaultInjector, LosesMessagesOfAllChannels) {
  EXPECT_NEAR(lost(outcomes("node", injection("loss", 0.5, "*"), 1000)), 500, 70);
  EXPECT_EQ(lost(outcomes("node", injection("drop", 1.0, "POSE"), 10)), 0);
}

TEST(FaultInjector, DelaysAndDuplicates) {
  FaultInjector injector("node");
  injector.inject(injection("delay", 0.5));
  injector.inject(injection("duplicate", 1.0));
  const auto passed = pass(injector, slip(1, 150));
  ASSERT_EQ(passed.size(), 2u);
  EXPECT_EQ(passed[0].delay, 500'000);
}

TEST(FaultInjector, ReordersTheFraction) {
  const auto all = outcomes("node", injection("reorder", 0.5), 1000);
  const auto late =
      std::count_if(all.begin(), all.end(), [](const auto& outcome) { return outcome.second == 3 * kTickUs; });
  EXPECT_NEAR(static_cast<double>(late), 500.0, 70.0);
}

TEST(FaultInjector, SlowDelaysAllMessagesOfAService) {
  FaultInjector injector("node");
  ASSERT_TRUE(injector.inject(injection("slow", 0.5, "localization")));
  ASSERT_TRUE(injector.inject(injection("slow", 0.5, "stereo")));
  EXPECT_EQ(pass(injector, slip(1, 150)).at(0).delay, 500'000);
}

TEST(FaultInjector, FreezesTheContentUnderFreshHeaders) {
  FaultInjector injector("node");
  injector.inject(injection("freeze", 0.0));
  pass(injector, slip(1, 150, 1.0));
  const slip_t frozen = decoded(pass(injector, slip(2, 160, 9.0)).at(0).bytes);
  EXPECT_EQ(frozen.header.seq, 2);
  EXPECT_DOUBLE_EQ(frozen.wheel_mps, 1.0);
}

TEST(FaultInjector, CorruptsOneBit) {
  FaultInjector injector("node");
  injector.inject(injection("corrupt", 1.0));
  const Bytes bytes = encoded(slip(1, 150));
  const auto passed = pass(injector, slip(1, 150));
  int bits = 0;
  for (size_t i = 0; i < bytes.size(); ++i) bits += __builtin_popcount(bytes[i] ^ passed.at(0).bytes[i]);
  EXPECT_EQ(bits, 1);
}

TEST(FaultInjector, OffsetsOneField) {
  FaultInjector injector("node");
  ASSERT_TRUE(injector.inject(injection("offset", 0.25, "SLIP.wheel_mps")));
  const slip_t changed = decoded(pass(injector, slip(1, 150, 1.0)).at(0).bytes);
  EXPECT_DOUBLE_EQ(changed.wheel_mps, 1.25);
  EXPECT_DOUBLE_EQ(changed.visual_mps, 0.0);
}

TEST(FaultInjector, MakesNanOfOneFieldOrOfAll) {
  FaultInjector one("node");
  one.inject(injection("nan", 1.0, "SLIP.wheel_mps"));
  const slip_t changed = decoded(pass(one, slip(1, 150)).at(0).bytes);
  EXPECT_TRUE(std::isnan(changed.wheel_mps));
  EXPECT_FALSE(std::isnan(changed.visual_mps));
  FaultInjector all("node");
  all.inject(injection("nan", 1.0, "POSE"));
  pose_t pose{};
  pose.header.utime = 150;
  const Bytes bytes = all.apply("POSE", pose.header, encoded(pose)).at(0).bytes;
  ASSERT_TRUE(decode_message(bytes.data(), static_cast<int>(bytes.size()), pose));
  EXPECT_TRUE(std::isnan(pose.covariance[35]));
  EXPECT_TRUE(std::isnan(pose.travelled_m));
}

TEST(FaultInjector, RepeatedInjectionIsActivatedOnce) {
  FaultInjector injector("node");
  injection_t what = injection("delay", 0.5);
  what.injection_id = 3;
  injector.inject(what);
  injector.inject(what);
  EXPECT_EQ(pass(injector, slip(1, 150)).at(0).delay, 500'000);
}

TEST(FaultInjector, DropsInjectionsThatEndedLongAgo) {
  FaultInjector injector("node");
  injector.inject(injection("drop", 1.0));
  EXPECT_TRUE(pass(injector, slip(1, 150)).empty());
  injection_t later = injection("drop", 1.0, "POSE");
  later.header.utime = 61'000'000;
  injector.inject(later);
  EXPECT_EQ(pass(injector, slip(2, 150)).size(), 1u);
}

TEST(FaultInjector, MutesChannelsAndRefusesOtherFaults) {
  FaultInjector injector("node");
  injector.mute("SLIP");
  EXPECT_TRUE(pass(injector, slip(1, 1)).empty());
  EXPECT_FALSE(injector.inject(injection("kill", 0.0)));
  EXPECT_FALSE(injector.inject(injection("camera_blind", 0.0)));
  EXPECT_FALSE(injector.inject(injection("no_such_fault", 1.0)));
  EXPECT_FALSE(injector.inject(injection("drop", 1.5)));
}

}  // namespace
}  // namespace rover
