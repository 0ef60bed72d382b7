#include "tools/replay/comparison.hpp"

#include <gtest/gtest.h>

#include "tools/replay/comparison_text.hpp"

namespace rover::replay {
namespace {

MessageName name(const std::string& channel, std::int64_t seq, const std::string& publisher = "stereo") {
  return {channel, publisher, 1, seq, seq * 100, seq * 100 + 20};
}

std::string no_field(const Difference&) {
  return {};
}

TEST(Comparison, EitherSideMayArriveFirst) {
  Comparison comparison;
  comparison.add_recorded(name("VO", 1), {1, 2});
  comparison.add_live(name("VO", 1), {1, 2});
  comparison.add_live(name("VO", 2), {3});
  comparison.add_recorded(name("VO", 2), {3});
  const auto results = comparison.finish(1'000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].identical, 2);
  EXPECT_FALSE(results[0].first);
  EXPECT_FALSE(first_of(results));
}

TEST(Comparison, OneBitDifferenceIsFoundAndEarliestIsReported) {
  Comparison comparison;
  for (std::int64_t seq = 1; seq <= 5; ++seq) {
    comparison.add_recorded(name("VO", seq), {7, 8, 9});
    comparison.add_live(name("VO", seq), {7, static_cast<std::uint8_t>(seq >= 3 ? 10 : 8), 9});
    comparison.add_recorded(name("POSE", seq, "localization"), {1});
    comparison.add_live(name("POSE", seq, "localization"), {static_cast<std::uint8_t>(seq >= 4 ? 2 : 1)});
  }
  const auto results = comparison.finish(1'000);
  ASSERT_EQ(results.size(), 2U);  // by channel
  EXPECT_EQ(results[0].channel, "POSE");
  EXPECT_EQ(results[0].identical, 3);
  EXPECT_EQ(results[1].identical, 2);
  const auto first = first_of(results);
  ASSERT_TRUE(first);
  EXPECT_EQ(difference_text(*first, no_field),
            "VO of stereo, seq 3, released at 0.000320 s: byte 1 of 3 is 08 in the log, 0a now");
}

TEST(Comparison, UnmatchedMessageIsADifferenceUpToEndTime) {
  Comparison comparison;
  comparison.add_recorded(name("VO", 1), {1});
  comparison.add_live(name("VO", 1), {1});
  comparison.add_recorded(name("VO", 2), {1});
  comparison.add_live(name("SLIP", 3), {1});
  comparison.add_live(name("PATH", 9), {1});  // released at 920
  const auto results = comparison.finish(900);
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].channel, "SLIP");
  EXPECT_EQ(results[0].first->kind, Difference::Kind::kNotInLog);
  EXPECT_EQ(results[1].first->kind, Difference::Kind::kMissingLive);
  EXPECT_EQ(results[1].first->name.seq, 2);
}

TEST(Comparison, RestartedProcessesAreComparedSeparately) {
  Comparison comparison;
  MessageName second = name("VO", 1);
  second.boot_id = 2;
  comparison.add_recorded(name("VO", 1), {1});
  comparison.add_recorded(second, {2});
  comparison.add_live(second, {2});
  comparison.add_live(name("VO", 1), {1});
  const auto results = comparison.finish(1'000);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].identical, 2);
  EXPECT_FALSE(results[0].first);
}

TEST(Comparison, DifferentLengthsAreReported) {
  Comparison comparison;
  comparison.add_recorded(name("VO", 1), {1, 2});
  comparison.add_live(name("VO", 1), {1, 2, 3});
  const auto first = first_of(comparison.finish(1'000));
  ASSERT_TRUE(first);
  EXPECT_NE(difference_text(*first, no_field).find("2 bytes in the log, 3 now"), std::string::npos);
}

}  // namespace
}  // namespace rover::replay
