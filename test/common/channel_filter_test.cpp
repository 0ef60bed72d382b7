#include "common/bus/channel_filter.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <lcm/lcm-cpp.hpp>
#include <rover/pose_t.hpp>
#include <set>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/node.hpp"

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
  ASSERT_TRUE(keep_channels({"POSE", "WHEEL_STATE", "VO"}, port_));
  const std::vector<std::pair<std::string, size_t>> others = {
      {"POS", 40},          {"POSE2", 40},      {"IMU", 40}, {"XPOSE", 40},
      {"WHEEL_STATES", 40}, {"WHEEL_STAT", 40}, {"V", 40},   {"", 40}};
  std::vector<std::pair<std::string, size_t>> all = others;
  all.insert(all.end(), {{"POSE", kSmallBytes}, {"VO", kSmallBytes}, {"WHEEL_STATE", kSmallBytes}});
  EXPECT_EQ(taken_of(all), (Taken{{"POSE", kSmallBytes}, {"VO", kSmallBytes}, {"WHEEL_STATE", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, LargeMessagesArriveWhereAChannelMayHaveThem) {
  ASSERT_TRUE(keep_channels({channel::kPath, channel::kPose}, port_));
  EXPECT_EQ(taken_of({{"IMU", kSmallBytes}, {"PATH", kLargeBytes}, {"POSE", kSmallBytes}}),
            (Taken{{"PATH", kLargeBytes}, {"POSE", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, FragmentsAreDroppedWhereNoChannelMayHaveThem) {
  ASSERT_TRUE(keep_channels({channel::kImu, channel::kPose}, port_));
  EXPECT_EQ(taken_of({{"PATH", kLargeBytes}, {"POSE", kLargeBytes}, {"IMU", kSmallBytes}}),
            (Taken{{"IMU", kSmallBytes}}));
}

TEST_F(ChannelFilterTest, SocketsOfOtherPortsAreLeftAlone) {
  EXPECT_FALSE(keep_channels({"POSE"}, port_ + 1));
  EXPECT_EQ(taken_of({{"IMU", kSmallBytes}, {"POSE", kSmallBytes}}),
            (Taken{{"IMU", kSmallBytes}, {"POSE", kSmallBytes}}));
}

// A node on the same bus, and what the world sends it.
class FilteredNodeTest : public ChannelFilterTest {
 protected:
  FilteredNodeTest() {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // LCM has threads of its own
    node_.subscribe<pose_t>(channel::kPose, [this](const pose_t&) { ++poses_; });
  }
  void send_pose_and_tick(Utime utime) {
    pose_t pose{};
    pose.header = world_.next(channel::kPose, utime, utime);
    sender_.publish(channel::kPose, &pose);
    tick_t tick{};
    tick.header = world_.next(channel::kTick, utime, utime);
    tick.mode = tick_t::REALTIME;
    sender_.publish(channel::kTick, &tick);
    for (int i = 0; i < 50 && node_.now() < utime; ++i) node_.handle(100);
  }

  lcm::LCM bus_{url_};
  Node node_{{.name = "node"}, bus_};
  StreamCounter world_{"world", 1};
  int poses_ = 0;
};

TEST_F(FilteredNodeTest, ItsInputsAndTicksArrive) {
  node_.close_subscriptions(port_);
  send_pose_and_tick(20'000);
  EXPECT_EQ(node_.now(), 20'000);
  EXPECT_EQ(poses_, 1);
}

TEST_F(FilteredNodeTest, WhereItIsSharedAllMessagesArrive) {
  std::vector<std::string> taken;
  node_.share_bus().subscribeFunction(
      channel::kImu,
      +[](const lcm::ReceiveBuffer*, const std::string& channel, std::vector<std::string>* out) {
        out->push_back(channel);
      },
      &taken);
  node_.close_subscriptions(port_);
  sender_.publish(channel::kImu, "imu", 3);
  send_pose_and_tick(20'000);
  EXPECT_EQ(taken, std::vector<std::string>{channel::kImu});
  EXPECT_EQ(poses_, 1);
}

TEST_F(FilteredNodeTest, ALateSubscriptionIsAMistake) {
  node_.close_subscriptions(port_);
  EXPECT_DEATH(node_.subscribe<pose_t>(channel::kSlip, [](const pose_t&) {}), "subscriptions_closed_");
  EXPECT_DEATH(node_.share_bus(), "subscriptions_closed_");
}

TEST_F(FilteredNodeTest, APatternIsNoChannel) {
  EXPECT_DEATH(node_.subscribe<pose_t>("NAVCAM_.*", [](const pose_t&) {}), "NAVCAM");
}

TEST(ChannelProgram, AllChannelsOfTheBusFitIn) {
  EXPECT_LT(channel_program(typed_channels()).size(), static_cast<size_t>(BPF_MAXINSNS));
}

TEST(ChannelProgram, ImagesAndPathsMayBeLargeTicksAndPosesNot) {
  for (const char* channel : {channel::kLocCamLeft, channel::kDisparity, channel::kCloud, channel::kPath,
                              channel::kGlobalPath, channel::kElevation, "ANOTHER"})
    EXPECT_FALSE(fits_a_datagram(channel)) << channel;
  for (const char* channel : {channel::kTick, channel::kPose, channel::kImu}) EXPECT_TRUE(fits_a_datagram(channel));
}

}  // namespace
}  // namespace rover
