#include "common/bus/streams.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <rover/slip_t.hpp>

namespace rover {
namespace {

header_t header_with_seq(std::int64_t seq) {
  header_t header;
  header.utime = header.release_utime = 0;
  header.seq = seq;
  header.publisher = "a";
  header.boot_id = 1;
  return header;
}

stream_seq_t until(std::int64_t seq) {
  stream_seq_t stream;
  stream.channel = "C";
  stream.publisher = "a";
  stream.boot_id = 1;
  stream.seq = seq;
  return stream;
}

TEST(ArrivalLedger, AHoleIsNotComplete) {
  ArrivalLedger ledger;
  EXPECT_FALSE(ledger.known(until(1)));
  EXPECT_TRUE(ledger.arrived("C", header_with_seq(1)));
  EXPECT_TRUE(ledger.arrived("C", header_with_seq(3)));
  EXPECT_FALSE(ledger.complete(until(3)));
  EXPECT_TRUE(ledger.arrived("C", header_with_seq(2)));
  EXPECT_TRUE(ledger.complete(until(3)));
}

TEST(ArrivalLedger, ARepeatedMessageIsNotNew) {
  ArrivalLedger ledger;
  EXPECT_TRUE(ledger.arrived("C", header_with_seq(5)));
  EXPECT_FALSE(ledger.arrived("C", header_with_seq(5)));
  EXPECT_TRUE(ledger.arrived("C", header_with_seq(7)));
  EXPECT_FALSE(ledger.arrived("C", header_with_seq(7)));
}

TEST(ArrivalLedger, GivingUpGoesOnBehindTheHole) {
  ArrivalLedger ledger;
  ledger.arrived("C", header_with_seq(1));
  ledger.arrived("C", header_with_seq(4));
  ledger.give_up(until(3));
  EXPECT_TRUE(ledger.complete(until(4)));
}

// In real time nobody gives up on a lost message.
TEST(ArrivalLedger, RemembersNoMoreThanAThousandMessagesBehindAHole) {
  ArrivalLedger ledger;
  ledger.arrived("C", header_with_seq(1));
  for (std::int64_t seq = 3; seq <= 1026; ++seq) EXPECT_TRUE(ledger.arrived("C", header_with_seq(seq)));
  EXPECT_FALSE(ledger.complete(until(3)));
  EXPECT_TRUE(ledger.arrived("C", header_with_seq(1027)));
  EXPECT_TRUE(ledger.complete(until(1027)));
  EXPECT_FALSE(ledger.arrived("C", header_with_seq(2)));
}

TEST(StreamCounter, CountsEachChannelAndListsWhatGrew) {
  StreamCounter counter("node", 3);
  counter.next("A", 0, 0);
  EXPECT_EQ(counter.next("A", 0, 0).seq, 2);
  EXPECT_EQ(counter.next("B", 0, 0).seq, 1);
  EXPECT_EQ(counter.take_updated().size(), 2u);
  EXPECT_TRUE(counter.take_updated().empty());
}

TEST(Peek, ShortBytesHaveNoHeader) {
  header_t header;
  const std::uint8_t bytes[12] = {};
  EXPECT_FALSE(peek_header(bytes, 8, header));
  EXPECT_FALSE(peek_header(bytes, 12, header));
}

// Times of damaged bytes; their differences would overflow.
TEST(Peek, TimesAndNumbersBeyondAllAreNoHeader) {
  const auto readable = [](auto change) {
    slip_t message{};
    change(message.header);
    const auto bytes = encoded(message);
    header_t header;
    return peek_header(bytes.data(), static_cast<int>(bytes.size()), header);
  };
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  EXPECT_TRUE(readable([](header_t& h) { h.utime = 1'700'000'000'000'000; }));  // since 1970
  EXPECT_TRUE(readable([](header_t& h) { h.utime = h.release_utime = kNever; }));
  EXPECT_FALSE(readable([](header_t& h) { h.utime = 4'213'092'985'657'280'000; }));
  EXPECT_FALSE(readable([](header_t& h) { h.release_utime = kLeast; }));
  EXPECT_FALSE(readable([](header_t& h) { h.seq = kLeast; }));
  EXPECT_FALSE(readable([](header_t& h) { h.boot_id = kLeast; }));
}

}  // namespace
}  // namespace rover
