// The bus subscriber on a bus of its own.
#include "tools/spy/bus_subscriber.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <rover/done_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/tick_t.hpp>

#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"
#include "messages.hpp"

namespace rover::spy {
namespace {

std::string own_bus() {
  return "udpm://239.255.76.67:" + std::to_string(21000 + getpid() % 8000) + "?ttl=0";
}

TEST(BusSubscriber, ReceivesBusAndDoneMessages) {
  Traffic traffic(Traffic::Rates::kRecent);
  BusSubscriber subscriber(own_bus(), traffic);
  lcm::LCM bus(own_bus());
  lcm::LCM reports(reports_url(own_bus()));
  ASSERT_TRUE(bus.good() && reports.good());
  constexpr std::int64_t kCount = 50;
  for (std::int64_t i = 1; i <= kCount; ++i) {
    const auto tick = made<tick_t>(i * kTickUs, i, "world");
    const auto done = made<done_t>(i * kTickUs, i, "stereo");
    const auto slip = made<slip_t>(i * kTickUs, i, "localization");
    bus.publish("TICK", &tick);
    bus.publish("SLIP", &slip);
    reports.publish("DONE", &done);
    subscriber.listen(20);
  }
  const auto heard = [&](const std::string& channel) {
    const TrafficStatistics statistics = traffic.statistics(0.0);
    return statistics.channels.contains(channel) ? statistics.channels.at(channel).messages : 0;
  };
  for (int i = 0; i < 500 && heard("SLIP") + heard("DONE") + heard("TICK") < 3 * kCount; ++i) subscriber.listen(20);
  EXPECT_EQ(heard("TICK"), kCount);
  EXPECT_EQ(heard("SLIP"), kCount);
  EXPECT_EQ(heard("DONE"), kCount);
}

TEST(BusSubscriber, BusThatCannotBeJoinedThrowsConfigError) {
  Traffic traffic(Traffic::Rates::kRecent);
  EXPECT_THROW(BusSubscriber("nonsense://", traffic), ConfigError);
}

}  // namespace
}  // namespace rover::spy
