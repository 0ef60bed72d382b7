#include "tools/spy/traffic.hpp"

#include <gmock/gmock.h>

#include <rover/slip_t.hpp>
#include <rover/tick_t.hpp>

#include "messages.hpp"
#include "wild.hpp"

namespace rover::spy {
namespace {

class TrafficTest : public testing::Test {
 protected:
  void add_message(Traffic& traffic, const std::string& channel, const std::vector<std::uint8_t>& bytes,
                   double wall_s) {
    traffic.add_message(channel, bytes.data(), static_cast<int>(bytes.size()), wall_s);
  }
  // TICK, and SLIP at each fifth tick, for `seconds` of message time at twice real time.
  void run(Traffic& traffic, double seconds, Utime from = 0) {
    for (Utime t = from; t < from + to_utime(seconds); t += kTickUs) {
      const double wall_s = 100.0 + 0.5 * to_seconds(t);
      add_message(traffic, "TICK", encoded(made<tick_t>(t, ++ticks_, "world")), wall_s);
      if (ticks_ % 5 == 0) add_message(traffic, "SLIP", encoded(made<slip_t>(t, ++slips_, "localization")), wall_s);
      now_ = wall_s;
    }
  }
  std::int64_t ticks_ = 0;
  std::int64_t slips_ = 0;
  double now_ = 0.0;
};

TEST_F(TrafficTest, RatesUseMessageTimeAndVolumesWallTime) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 20.0);
  const TrafficStatistics statistics = traffic.statistics(now_);
  EXPECT_NEAR(statistics.channels.at("SLIP").hz, 10.0, 0.1);
  EXPECT_NEAR(statistics.channels.at("TICK").hz, 50.0, 0.5);
  EXPECT_NEAR(statistics.realtime_factor, 2.0, 0.01);
  const auto size = static_cast<double>(encoded(made<slip_t>(0, 1, "localization")).size());
  EXPECT_NEAR(statistics.channels.at("SLIP").bytes_per_s, 20.0 * size, size);
  EXPECT_EQ(statistics.channels.at("SLIP").messages, 200);
  EXPECT_EQ(statistics.channels.at("SLIP").type, "slip_t");
  EXPECT_THAT(statistics.channels.at("SLIP").publishers, testing::ElementsAre("localization"));
}

TEST_F(TrafficTest, AgeIsMeasurementAge) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 2.0);
  add_message(traffic, "TICK", encoded(made<tick_t>(3'000'000, 1000, "world")), now_);
  EXPECT_NEAR(traffic.statistics(now_).channels.at("SLIP").age_s, 3.0 - 1.98, 1e-9);
}

TEST_F(TrafficTest, GapsAndMalformedMessagesAreCounted) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 1.0);
  slips_ += 3;
  run(traffic, 1.0, 1'000'000);
  auto damaged = encoded(made<slip_t>(0, 1, "localization"));
  damaged.pop_back();
  add_message(traffic, "SLIP", damaged, now_);
  const ChannelStatistics slip = traffic.statistics(now_).channels.at("SLIP");
  EXPECT_EQ(slip.gaps, 3);
  EXPECT_EQ(slip.malformed, 1);
  EXPECT_EQ(slip.messages, 20);
}

TEST_F(TrafficTest, LogRatesUseWholeLength) {
  Traffic traffic(Traffic::Rates::kWhole);
  run(traffic, 10.0);
  run(traffic, 10.0, 90'000'000);  // including a long gap
  const ChannelStatistics slip = traffic.statistics(now_).channels.at("SLIP");
  EXPECT_NEAR(slip.hz, 200.0 / 50.0, 0.01) << "per second of the log";
  EXPECT_TRUE(std::isnan(traffic.statistics(now_).realtime_factor));
}

TEST_F(TrafficTest, WallTimeReplacesMessageTimeWithoutTicks) {
  Traffic traffic(Traffic::Rates::kRecent);
  for (int i = 0; i < 100; ++i)
    add_message(traffic, "SLIP", encoded(made<slip_t>(20'000 * i, i + 1, "localization")), 5.0 + 0.02 * i);
  const TrafficStatistics statistics = traffic.statistics(7.0);
  EXPECT_EQ(statistics.now, kNever);
  EXPECT_NEAR(statistics.channels.at("SLIP").hz, 50.0, 1.0);
  EXPECT_TRUE(std::isnan(statistics.channels.at("SLIP").age_s));
}

TEST_F(TrafficTest, UnknownChannelIsCounted) {
  Traffic traffic(Traffic::Rates::kRecent);
  for (int i = 0; i < 10; ++i) add_message(traffic, "FOREIGN", {1, 2, 3}, 5.0 + 0.1 * i);
  const ChannelStatistics foreign = traffic.statistics(6.0).channels.at("FOREIGN");
  EXPECT_EQ(foreign.messages, 10);
  EXPECT_EQ(foreign.bytes, 30);
  EXPECT_EQ(foreign.gaps, 0);
  EXPECT_EQ(foreign.malformed, 0);
  EXPECT_EQ(foreign.type, "");
}

TEST_F(TrafficTest, TimeGoingBackResetsStatistics) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 3.0);
  const double wall_s = now_ + 1.0;
  add_message(traffic, "TICK", encoded(made<tick_t>(0, 1, "world")), wall_s);
  add_message(traffic, "SLIP", encoded(made<slip_t>(0, 1, "localization")), wall_s);
  const TrafficStatistics statistics = traffic.statistics(wall_s);
  EXPECT_EQ(statistics.now, 0);
  EXPECT_EQ(statistics.channels.at("SLIP").messages, 1);
  EXPECT_EQ(statistics.channels.at("SLIP").gaps, 0);
}

// The TICK that starts a run is counted as the first message of that run.
TEST_F(TrafficTest, FirstTickOfRunIsCountedInThatRun) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 3.0);
  for (const double wall_s : {now_ + 1.0, now_ + 2.0}) {  // a third run ends the second one
    add_message(traffic, "TICK", encoded(made<tick_t>(0, 1, "world")), wall_s);
    EXPECT_EQ(traffic.statistics(wall_s).channels.size(), 1U);
    EXPECT_EQ(traffic.statistics(wall_s).channels.at("TICK").messages, 1);
    add_message(traffic, "TICK", encoded(made<tick_t>(kTickUs, 2, "world")), wall_s);
    EXPECT_EQ(traffic.statistics(wall_s).channels.at("TICK").messages, 2);
    EXPECT_EQ(traffic.statistics(wall_s).channels.at("TICK").gaps, 0);
  }
  wild_row(
      "Logs", "a new run begins under a running spy", "heap corruption",
      std::to_string(traffic.statistics(now_ + 2.0).channels.at("TICK").messages) + " TICKs of the new run counted");
}

TEST_F(TrafficTest, RatesRecoverAfterJumpOfDays) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 3.0);
  constexpr Utime kDays = 200'000'000'000;
  for (Utime t = kDays; t < kDays + 2'000'000; t += kTickUs)
    add_message(traffic, "TICK", encoded(made<tick_t>(t, ++ticks_, "world")), now_ += 0.01);
  const TrafficStatistics statistics = traffic.statistics(now_);
  EXPECT_EQ(statistics.now, kDays + 1'980'000);
  EXPECT_NEAR(statistics.channels.at("TICK").hz, 50.0, 0.6);
  EXPECT_EQ(statistics.channels.at("TICK").gaps, 0);
  EXPECT_NEAR(statistics.realtime_factor, 2.0, 0.1);
}

}  // namespace
}  // namespace rover::spy
