#include "common/bus/bus_url.hpp"

#include <gtest/gtest.h>

#include "common/bus/config.hpp"

namespace rover {
namespace {

TEST(BusUrl, ItsPartsAreRead) {
  const auto address = parse_udpm("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->group, "239.255.76.67");
  EXPECT_EQ(address->port, 7667);
  EXPECT_EQ(address->receive_buffer, 4194304);
  for (const char* other :
       {"memq://", "udpm://239.255.76.67", "udpm://239.255.76.67:123456", "file:///a.lcm", "udpm://10.0.0.1:7667",
        "udpm://239.255.76.67:7667?ttl=0;rm", "udpm://239.255.76.67:7667?colour=1",
        "udpm://239.255.76.67:7667?ttl=", "udpm://239.255.76.67:7667?ttl=-1", ""})
    EXPECT_FALSE(parse_udpm(other)) << other;
}

TEST(BusUrl, OneWithoutEndIsNone) {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  for (int i = 0; i < 100'000; ++i) url += "&ttl=0";
  EXPECT_FALSE(parse_udpm(url));
}

TEST(BusUrl, ReportsHaveAPortOfTheirOwn) {
  EXPECT_EQ(reports_url("udpm://239.255.76.67:7667?ttl=0"), "udpm://239.255.76.67:17667?ttl=0");
  EXPECT_EQ(reports_url("udpm://239.255.76.67:55535"), "udpm://239.255.76.67:65535");
  EXPECT_EQ(reports_url("memq://"), "memq://");
  EXPECT_THROW(reports_url("udpm://239.255.76.67:55536?ttl=0"), ConfigError);
}

}  // namespace
}  // namespace rover
