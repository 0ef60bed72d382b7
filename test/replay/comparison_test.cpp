#include "tools/replay/comparison.hpp"

#include <gtest/gtest.h>

#include "tools/replay/verdict_text.hpp"

namespace rover::replay {
namespace {

MessageName name(const std::string& channel, std::int64_t seq, const std::string& publisher = "stereo") {
  return {channel, publisher, 1, seq, seq * 100, seq * 100 + 20};
}

std::string no_field(const Difference&) {
  return {};
}

TEST(Comparison, either_side_may_come_first) {
  Comparison comparison;
  comparison.recorded(name("VO", 1), {1, 2});
  comparison.said_now(name("VO", 1), {1, 2});
  comparison.said_now(name("VO", 2), {3});
  comparison.recorded(name("VO", 2), {3});
  const auto verdicts = comparison.finish(1'000);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].identical, 2);
  EXPECT_FALSE(verdicts[0].first);
  EXPECT_FALSE(first_of(verdicts));
}

TEST(Comparison, one_bit_is_found_and_the_earliest_is_named) {
  Comparison comparison;
  for (std::int64_t seq = 1; seq <= 5; ++seq) {
    comparison.recorded(name("VO", seq), {7, 8, 9});
    comparison.said_now(name("VO", seq), {7, static_cast<std::uint8_t>(seq >= 3 ? 10 : 8), 9});
    comparison.recorded(name("POSE", seq, "localization"), {1});
    comparison.said_now(name("POSE", seq, "localization"), {static_cast<std::uint8_t>(seq >= 4 ? 2 : 1)});
  }
  const auto verdicts = comparison.finish(1'000);
  ASSERT_EQ(verdicts.size(), 2U);  // by channel
  EXPECT_EQ(verdicts[0].channel, "POSE");
  EXPECT_EQ(verdicts[0].identical, 3);
  EXPECT_EQ(verdicts[1].identical, 2);
  const auto first = first_of(verdicts);
  ASSERT_TRUE(first);
  EXPECT_EQ(difference_text(*first, no_field),
            "VO of stereo, seq 3, released at 0.000320 s: byte 1 of 3 is 08 in the log, 0a now");
}

TEST(Comparison, what_only_one_side_said_is_a_difference_up_to_the_end) {
  Comparison comparison;
  comparison.recorded(name("VO", 1), {1});
  comparison.said_now(name("VO", 1), {1});
  comparison.recorded(name("VO", 2), {1});
  comparison.said_now(name("SLIP", 3), {1});
  comparison.said_now(name("PATH", 9), {1});  // released at 920
  const auto verdicts = comparison.finish(900);
  ASSERT_EQ(verdicts.size(), 2U);
  EXPECT_EQ(verdicts[0].channel, "SLIP");
  EXPECT_EQ(verdicts[0].first->kind, Difference::Kind::kNotInLog);
  EXPECT_EQ(verdicts[1].first->kind, Difference::Kind::kMissingNow);
  EXPECT_EQ(verdicts[1].first->name.seq, 2);
}

TEST(Comparison, processes_of_one_service_are_told_apart) {
  Comparison comparison;
  MessageName second = name("VO", 1);
  second.boot_id = 2;
  comparison.recorded(name("VO", 1), {1});
  comparison.recorded(second, {2});
  comparison.said_now(second, {2});
  comparison.said_now(name("VO", 1), {1});
  const auto verdicts = comparison.finish(1'000);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].identical, 2);
  EXPECT_FALSE(verdicts[0].first);
}

TEST(Comparison, lengths_differ) {
  Comparison comparison;
  comparison.recorded(name("VO", 1), {1, 2});
  comparison.said_now(name("VO", 1), {1, 2, 3});
  const auto first = first_of(comparison.finish(1'000));
  ASSERT_TRUE(first);
  EXPECT_NE(difference_text(*first, no_field).find("2 bytes in the log, 3 now"), std::string::npos);
}

}  // namespace
}  // namespace rover::replay
