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
  void hear(Traffic& traffic, const std::string& channel, const std::vector<std::uint8_t>& bytes, double wall_s) {
    traffic.hear(channel, bytes.data(), static_cast<int>(bytes.size()), wall_s);
  }
  // Ticks, and SLIP each fifth one, for `seconds` of message time at twice its speed.
  void run(Traffic& traffic, double seconds, Utime from = 0) {
    for (Utime t = from; t < from + to_utime(seconds); t += kTickUs) {
      const double wall_s = 100.0 + 0.5 * to_seconds(t);
      hear(traffic, "TICK", encoded(made<tick_t>(t, ++ticks_, "world")), wall_s);
      if (ticks_ % 5 == 0) hear(traffic, "SLIP", encoded(made<slip_t>(t, ++slips_, "localization")), wall_s);
      now_ = wall_s;
    }
  }
  std::int64_t ticks_ = 0;
  std::int64_t slips_ = 0;
  double now_ = 0.0;
};

TEST_F(TrafficTest, RatesAreOfMessageTimeAndVolumesOfTheClock) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 20.0);
  const Figures figures = traffic.figures(now_);
  EXPECT_NEAR(figures.channels.at("SLIP").hz, 10.0, 0.1);
  EXPECT_NEAR(figures.channels.at("TICK").hz, 50.0, 0.5);
  EXPECT_NEAR(figures.realtime_factor, 2.0, 0.01);
  const auto size = static_cast<double>(encoded(made<slip_t>(0, 1, "localization")).size());
  EXPECT_NEAR(figures.channels.at("SLIP").bytes_per_s, 20.0 * size, size);
  EXPECT_EQ(figures.channels.at("SLIP").messages, 200);
  EXPECT_EQ(figures.channels.at("SLIP").type, "slip_t");
  EXPECT_THAT(figures.channels.at("SLIP").publishers, testing::ElementsAre("localization"));
}

TEST_F(TrafficTest, AgeIsThatOfTheMeasurement) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 2.0);
  hear(traffic, "TICK", encoded(made<tick_t>(3'000'000, 1000, "world")), now_);
  EXPECT_NEAR(traffic.figures(now_).channels.at("SLIP").age_s, 3.0 - 1.98, 1e-9);
}

TEST_F(TrafficTest, GapsAndDamagesAreCounted) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 1.0);
  slips_ += 3;
  run(traffic, 1.0, 1'000'000);
  auto damaged = encoded(made<slip_t>(0, 1, "localization"));
  damaged.pop_back();
  hear(traffic, "SLIP", damaged, now_);
  const ChannelFigures slip = traffic.figures(now_).channels.at("SLIP");
  EXPECT_EQ(slip.gaps, 3);
  EXPECT_EQ(slip.malformed, 1);
  EXPECT_EQ(slip.messages, 20);
}

TEST_F(TrafficTest, ALogIsRatedAsAWhole) {
  Traffic traffic(Traffic::Rates::kWhole);
  run(traffic, 10.0);
  run(traffic, 10.0, 90'000'000);  // with a long silence in it
  const ChannelFigures slip = traffic.figures(now_).channels.at("SLIP");
  EXPECT_NEAR(slip.hz, 200.0 / 50.0, 0.01) << "per second of the log";
  EXPECT_TRUE(std::isnan(traffic.figures(now_).realtime_factor));
}

TEST_F(TrafficTest, WithoutTicksTheClockServes) {
  Traffic traffic(Traffic::Rates::kRecent);
  for (int i = 0; i < 100; ++i)
    hear(traffic, "SLIP", encoded(made<slip_t>(20'000 * i, i + 1, "localization")), 5.0 + 0.02 * i);
  const Figures figures = traffic.figures(7.0);
  EXPECT_EQ(figures.now, kNever);
  EXPECT_NEAR(figures.channels.at("SLIP").hz, 50.0, 1.0);
  EXPECT_TRUE(std::isnan(figures.channels.at("SLIP").age_s));
}

TEST_F(TrafficTest, AChannelOfSomebodyElseIsCountedToo) {
  Traffic traffic(Traffic::Rates::kRecent);
  for (int i = 0; i < 10; ++i) hear(traffic, "FOREIGN", {1, 2, 3}, 5.0 + 0.1 * i);
  const ChannelFigures foreign = traffic.figures(6.0).channels.at("FOREIGN");
  EXPECT_EQ(foreign.messages, 10);
  EXPECT_EQ(foreign.bytes, 30);
  EXPECT_EQ(foreign.gaps, 0);
  EXPECT_EQ(foreign.malformed, 0);
  EXPECT_EQ(foreign.type, "");
}

TEST_F(TrafficTest, AnotherWorldBeginsAnew) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 3.0);
  const double wall_s = now_ + 1.0;
  hear(traffic, "TICK", encoded(made<tick_t>(0, 1, "world")), wall_s);
  hear(traffic, "SLIP", encoded(made<slip_t>(0, 1, "localization")), wall_s);
  const Figures figures = traffic.figures(wall_s);
  EXPECT_EQ(figures.now, 0);
  EXPECT_EQ(figures.channels.at("SLIP").messages, 1);
  EXPECT_EQ(figures.channels.at("SLIP").gaps, 0);
}

// The TICK that begins a run is itself the first message of the new accounts.
TEST_F(TrafficTest, TheTickThatBeginsARunIsCountedInIt) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 3.0);
  for (const double wall_s : {now_ + 1.0, now_ + 2.0}) {  // the second run is ended by a third
    hear(traffic, "TICK", encoded(made<tick_t>(0, 1, "world")), wall_s);
    EXPECT_EQ(traffic.figures(wall_s).channels.size(), 1U);
    EXPECT_EQ(traffic.figures(wall_s).channels.at("TICK").messages, 1);
    hear(traffic, "TICK", encoded(made<tick_t>(kTickUs, 2, "world")), wall_s);
    EXPECT_EQ(traffic.figures(wall_s).channels.at("TICK").messages, 2);
    EXPECT_EQ(traffic.figures(wall_s).channels.at("TICK").gaps, 0);
  }
  wild_row("Logs", "a new run begins under a running spy", "heap corruption",
           std::to_string(traffic.figures(now_ + 2.0).channels.at("TICK").messages) + " TICKs of the new run counted");
}

TEST_F(TrafficTest, AJumpOfDaysLeavesTheRatesThatFollow) {
  Traffic traffic(Traffic::Rates::kRecent);
  run(traffic, 3.0);
  constexpr Utime kDays = 200'000'000'000;
  for (Utime t = kDays; t < kDays + 2'000'000; t += kTickUs)
    hear(traffic, "TICK", encoded(made<tick_t>(t, ++ticks_, "world")), now_ += 0.01);
  const Figures figures = traffic.figures(now_);
  EXPECT_EQ(figures.now, kDays + 1'980'000);
  EXPECT_NEAR(figures.channels.at("TICK").hz, 50.0, 0.6);
  EXPECT_EQ(figures.channels.at("TICK").gaps, 0);
  EXPECT_NEAR(figures.realtime_factor, 2.0, 0.1);
}

}  // namespace
}  // namespace rover::spy
