#include "common/bus/tap.hpp"

#include <gtest/gtest.h>

#include <rover/slip_t.hpp>

namespace rover {
namespace {

std::vector<std::uint8_t> encoded(std::int64_t seq, double value) {
  slip_t slip{};
  slip.header.seq = seq;
  slip.header.publisher = "localization";
  slip.wheel_mps = value;
  std::vector<std::uint8_t> bytes(static_cast<size_t>(slip.getEncodedSize()));
  slip.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

injection_t injection(const std::string& fault, double amount) {
  injection_t what{};
  what.target = "SLIP";
  what.fault = fault;
  what.amount = amount;
  what.from_utime = 100;
  what.until_utime = 200;
  return what;
}

std::vector<Tap::Passed> pass(Tap& tap, Utime utime, const std::vector<std::uint8_t>& bytes) {
  return tap.pass("SLIP", utime, bytes.data(), static_cast<int>(bytes.size()));
}

TEST(Tap, LetsAllThroughUntouchedOutsideOfTheTime) {
  Tap tap(1);
  ASSERT_TRUE(tap.inject(injection("drop", 1.0)));
  EXPECT_EQ(pass(tap, 99, encoded(1, 1.0)).size(), 1u);
  EXPECT_EQ(pass(tap, 150, encoded(2, 1.0)).size(), 0u);
  EXPECT_EQ(pass(tap, 201, encoded(3, 1.0)).size(), 1u);
}

TEST(Tap, DelaysAndDuplicates) {
  Tap tap(1);
  tap.inject(injection("delay", 0.5));
  tap.inject(injection("duplicate", 1.0));
  const auto passed = pass(tap, 150, encoded(1, 1.0));
  ASSERT_EQ(passed.size(), 2u);
  EXPECT_EQ(passed[0].delay, 500'000);
}

TEST(Tap, FreezesTheContentUnderFreshHeaders) {
  Tap tap(1);
  tap.inject(injection("freeze", 1.0));
  pass(tap, 150, encoded(1, 1.0));
  const auto passed = pass(tap, 160, encoded(2, 9.0));
  slip_t slip;
  ASSERT_GT(slip.decode(passed.at(0).bytes.data(), 0, static_cast<int>(passed[0].bytes.size())), 0);
  EXPECT_EQ(slip.header.seq, 2);
  EXPECT_DOUBLE_EQ(slip.wheel_mps, 1.0);
}

TEST(Tap, CorruptsOneBit) {
  Tap tap(1);
  tap.inject(injection("corrupt", 1.0));
  const auto bytes = encoded(1, 1.0);
  const auto passed = pass(tap, 150, bytes);
  int bits = 0;
  for (size_t i = 0; i < bytes.size(); ++i) bits += __builtin_popcount(bytes[i] ^ passed.at(0).bytes[i]);
  EXPECT_EQ(bits, 1);
}

TEST(Tap, MutesAndRefusesWhatItDoesNotKnow) {
  Tap tap(1);
  tap.mute("SLIP");
  EXPECT_TRUE(pass(tap, 1, encoded(1, 1.0)).empty());
  EXPECT_FALSE(tap.inject(injection("kill", 1.0)));
}

}  // namespace
}  // namespace rover
