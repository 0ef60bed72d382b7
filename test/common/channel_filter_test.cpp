#include "common/bus/channel_filter.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <lcm/lcm-cpp.hpp>
#include <set>

#include "common/bus/channels.hpp"

namespace rover {
namespace {

constexpr size_t kSmallBytes = 40;
constexpr size_t kLargeBytes = 200'000;

class ChannelFilterTest : public testing::Test {
 protected:
  using Taken = std::multiset<std::pair<std::string, size_t>>;

  ChannelFilterTest() {
    receiver_.subscribeFunction(
        ".*",
        +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Taken* taken) {
          if (channel != "LCM_SELF_TEST") taken->emplace(channel, buffer->data_size);
        },
        &taken_);
  }

  // What of the messages arrives; the last one is always taken, and nothing overtakes another message.
  Taken taken_of(const std::vector<std::pair<std::string, size_t>>& messages) {
    for (const auto& [channel, size] : messages) {
      const std::vector<std::uint8_t> bytes(size, 7);
      sender_.publish(channel, bytes.data(), static_cast<unsigned int>(size));
    }
    while (!taken_.contains(messages.back()) && receiver_.handleTimeout(5000) > 0) {
    }
    return taken_;
  }

  int port_ = 21000 + getpid() % 8000;
  std::string url_ = "udpm://239.255.76.67:" + std::to_string(port_) + "?ttl=0&recv_buf_size=4194304";
  lcm::LCM sender_{url_};
  lcm::LCM receiver_{url_};
  Taken taken_;
};

TEST_F(ChannelFilterTest, OnlyTheseChannelsArrive) {
  keep_channels({"POSE", "WHEEL_STATE", "VO"}, port_);
  const std::vector<std::pair<std::string, size_t>> others = {
      {"POS", 40},          {"POSE2", 40},      {"IMU", 40}, {"XPOSE", 40},
      {"WHEEL_STATES", 40}, {"WHEEL_STAT", 40}, {"V", 40},   {"", 40}};
  std::vector<std::pair<std::string, size_t>> all = others;
  all.insert(all.end(), {{"POSE", kSmallBytes}, {"VO", kSmallBytes}, {"WHEEL_STATE", kSmallBytes}});
  EXPECT_EQ(taken_of(all), (Taken{{"POSE", kSmallBytes}, {"VO", kSmallBytes}, {"WHEEL_STATE", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, LargeMessagesArriveWhereAChannelMayHaveThem) {
  keep_channels({channel::kPath, channel::kPose}, port_);
  EXPECT_EQ(taken_of({{"IMU", kSmallBytes}, {"PATH", kLargeBytes}, {"POSE", kSmallBytes}}),
            (Taken{{"PATH", kLargeBytes}, {"POSE", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, FragmentsAreDroppedWhereNoChannelMayHaveThem) {
  keep_channels({channel::kImu, channel::kPose}, port_);
  EXPECT_EQ(taken_of({{"PATH", kLargeBytes}, {"POSE", kLargeBytes}, {"IMU", kSmallBytes}}),
            (Taken{{"IMU", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, ALaterFilterReplacesTheFirst) {
  keep_channels({"POSE"}, port_);
  keep_channels({"IMU"}, port_);
  EXPECT_EQ(taken_of({{"POSE", kSmallBytes}, {"IMU", kSmallBytes}}), (Taken{{"IMU", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, SocketsOfOtherPortsAreLeftAlone) {
  keep_channels({"POSE"}, port_ + 1);
  EXPECT_EQ(taken_of({{"IMU", kSmallBytes}, {"POSE", kSmallBytes}}),
            (Taken{{"IMU", kSmallBytes}, {"POSE", kSmallBytes}}));
}

TEST(ChannelProgram, AllChannelsOfTheBusFitIn) {
  std::vector<std::string> channels;
  for (int i = 0; i < 60; ++i) channels.push_back("A_CHANNEL_WITH_A_LONG_NAME_" + std::to_string(i));
  EXPECT_LT(channel_program(channels).size(), static_cast<size_t>(BPF_MAXINSNS));
}

TEST(ChannelProgram, ImagesAndPathsMayBeLargeTicksAndPosesNot) {
  for (const char* channel : {channel::kLocCamLeft, channel::kDisparity, channel::kCloud, channel::kPath,
                              channel::kGlobalPath, channel::kElevation, "ANOTHER"})
    EXPECT_FALSE(fits_a_datagram(channel)) << channel;
  for (const char* channel : {channel::kTick, channel::kPose, channel::kImu}) EXPECT_TRUE(fits_a_datagram(channel));
}

}  // namespace
}  // namespace rover
