#include "recorder/node.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <rover/image_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <set>

#include "common/bus/streams.hpp"
#include "read_back.hpp"

namespace rover::recorder {
namespace {

constexpr std::uintmax_t kPlenty = 100'000'000'000;

RecorderConfig config(bool reduced = false) {
  RecorderConfig c;
  c.keep.reduced = reduced;
  c.keep.images_before_s = 1.0;
  c.keep.images_after_s = 0.5;
  c.keep.bulk_channels = {channel::kLocCamLeft};
  return c;
}

// Simulated bus around one recorder.
class World {
 public:
  World(const std::string& path, const RecorderConfig& config, RecorderNode::FreeBytes free_bytes)
      : bus_("memq://"), streams_("world", 1), node_({.name = "recorder", .allow_injection = true}, bus_) {
    bus_.subscribeFunction(channel::kHeartbeat, &World::on_heartbeat, this);
    bus_.subscribeFunction(channel::kDone, &World::on_done, this);
    recorder_ = std::make_unique<RecorderNode>(node_, config, path, std::move(free_bytes));
  }

  template <class Message>
  Message made(const std::string& channel, Utime utime) {
    Message message{};
    message.header = streams_.next(channel, utime, utime);
    return message;
  }
  template <class Message>
  void publish(const std::string& channel, const Message& message) {
    bus_.publish(channel, &message);
  }
  void tick(Utime utime) {
    auto message = made<tick_t>(channel::kTick, utime);
    message.mode = tick_t::LOCKSTEP;
    message.members = {"recorder"};
    message.member_count = 1;
    publish(channel::kTick, message);
    while (bus_.handleTimeout(0) > 0) node_.handle(0);
    node_.handle(0);
  }
  void close() { recorder_.reset(); }

  std::vector<heartbeat_t> heartbeats_;
  std::int64_t dones_ = 0;

 private:
  // Plain functions: GCC 12's sanitizers misread LCM's calls through pointers to members.
  static void on_heartbeat(const lcm::ReceiveBuffer*, const std::string&, const heartbeat_t* heartbeat, World* world) {
    world->heartbeats_.push_back(*heartbeat);
  }
  static void on_done(const lcm::ReceiveBuffer*, const std::string&, const done_t*, World* world) { ++world->dones_; }

  lcm::LCM bus_;
  StreamCounter streams_;
  Node node_;
  std::unique_ptr<RecorderNode> recorder_;
};

class RecorderNodeTest : public testing::Test {
 protected:
  RecorderNodeTest() : path_(testing::TempDir() + "/recorder_node_test.lcm") { std::filesystem::remove(path_); }

  size_t count(const std::string& channel) const {
    const std::vector<ReadBack> events = read_back(path_);
    return static_cast<size_t>(
        std::count_if(events.begin(), events.end(), [&](const ReadBack& event) { return event.channel == channel; }));
  }

  std::string path_;
};

TEST_F(RecorderNodeTest, RecordsEveryChannelIncludingItsOwn) {
  World world(path_, config(), [] { return kPlenty; });
  for (Utime t = 0; t <= 400'000; t += kTickUs) {
    world.publish("SLIP", world.made<slip_t>("SLIP", t));
    world.tick(t);
  }
  world.close();
  EXPECT_EQ(count("SLIP"), 21u);
  EXPECT_EQ(count("TICK"), 21u);
  EXPECT_GE(count("HEARTBEAT"), 2u);
  EXPECT_EQ(count("DONE"), 0u);
}

TEST_F(RecorderNodeTest, LogDoesNotDependOnArrivalOrder) {
  std::vector<std::vector<ReadBack>> logs;
  for (const bool swapped : {false, true}) {
    std::filesystem::remove(path_);
    World world(path_, config(), [] { return kPlenty; });
    for (Utime t = 0; t <= 1'000'000; t += kTickUs) {
      const auto a = world.made<slip_t>("SLIP", t);
      const auto b = world.made<slip_t>("IMU", t);
      if (swapped) world.publish("SLIP", a);
      world.publish("IMU", b);
      if (!swapped) world.publish("SLIP", a);
      world.tick(t);
    }
    world.close();
    logs.push_back(read_back(path_));
    // Heartbeats carry processor times.
    std::erase_if(logs.back(), [](const ReadBack& event) { return event.channel == "HEARTBEAT"; });
  }
  ASSERT_GT(logs[0].size(), 100u);
  ASSERT_EQ(logs[0].size(), logs[1].size());
  for (size_t i = 0; i < logs[0].size(); ++i) {
    EXPECT_EQ(logs[0][i].channel, logs[1][i].channel);
    EXPECT_EQ(logs[0][i].timestamp, logs[1][i].timestamp);
    EXPECT_EQ(logs[0][i].bytes, logs[1][i].bytes) << i << ' ' << logs[0][i].channel;
  }
}

TEST_F(RecorderNodeTest, DoesNotStartWithLowDiskSpace) {
  lcm::LCM bus("memq://");
  Node node({.name = "recorder"}, bus);
  try {
    const RecorderNode recorder(node, config(), path_, [] { return std::uintmax_t{900'000'000}; });
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("min_free_start_gb"), std::string::npos) << error.what();
  }
}

TEST_F(RecorderNodeTest, FullDiskStopsRecordingNotTheNode) {
  std::uintmax_t free_bytes = kPlenty;
  World world(path_, config(), [&] { return free_bytes; });
  Utime t = 0;
  for (; t <= 3'000'000; t += kTickUs) world.tick(t);
  free_bytes = 1'000'000;
  const std::int64_t dones = world.dones_;
  for (; t <= 6'000'000; t += kTickUs) world.tick(t);
  EXPECT_EQ(world.heartbeats_.front().status, std::int8_t{heartbeat_t::OK});
  EXPECT_EQ(world.heartbeats_.back().status, std::int8_t{heartbeat_t::DEGRADED});
  EXPECT_NE(world.heartbeats_.back().text.find("disk full"), std::string::npos);
  EXPECT_GE(world.dones_ - dones, 149);
  const size_t ticks = count("TICK");
  EXPECT_GE(ticks, 150u);
  EXPECT_LE(ticks, 205u);
}

TEST_F(RecorderNodeTest, RestartWithLowDiskSpaceDoesNotEndTheDrive) {
  Utime t = 0;
  {
    World world(path_, config(), [] { return kPlenty; });
    for (; t <= 1'000'000; t += kTickUs) world.tick(t);
  }
  std::uintmax_t free_bytes = 900'000'000;
  World world(path_, config(), [&] { return free_bytes; });
  for (; t <= 3'000'000; t += kTickUs) world.tick(t);
  EXPECT_EQ(world.heartbeats_.back().status, std::int8_t{heartbeat_t::DEGRADED});
  const size_t before = count("TICK");
  free_bytes = kPlenty;
  for (; t <= 20'000'000; t += kTickUs) world.tick(t);
  EXPECT_EQ(world.heartbeats_.back().status, std::int8_t{heartbeat_t::OK});
  EXPECT_GT(count("TICK"), before);
}

TEST_F(RecorderNodeTest, ResumesWhenDiskSpaceIsAvailable) {
  std::uintmax_t free_bytes = kPlenty;
  World world(path_, config(), [&] { return free_bytes; });
  Utime t = 0;
  for (; t <= 3'000'000; t += kTickUs) world.tick(t);
  free_bytes = 1'000'000;
  for (; t <= 6'000'000; t += kTickUs) world.tick(t);
  free_bytes = kPlenty;
  for (; t <= 30'000'000; t += kTickUs) world.tick(t);
  EXPECT_EQ(world.heartbeats_.back().status, std::int8_t{heartbeat_t::OK});
  const size_t ticks = count("TICK");
  EXPECT_GE(ticks, 150u + 750u);
  EXPECT_LE(ticks, 1501u - 450u);
}

TEST_F(RecorderNodeTest, InjectedFullDiskStopsRecording) {
  World world(path_, config(), [] { return kPlenty; });
  Utime t = 0;
  for (; t <= 2'000'000; t += kTickUs) world.tick(t);
  auto injection = world.made<injection_t>(channel::kInject, t);
  injection.fault = "full_disk";
  injection.target = "recorder";
  injection.from_utime = t;
  injection.until_utime = t + 2'000'000;
  world.publish(channel::kInject, injection);
  for (; t <= 4'000'000; t += kTickUs) world.tick(t);
  EXPECT_EQ(world.heartbeats_.front().status, std::int8_t{heartbeat_t::OK});
  EXPECT_EQ(world.heartbeats_.back().status, std::int8_t{heartbeat_t::DEGRADED});
  EXPECT_EQ(count("INJECT"), 1u);
}

TEST_F(RecorderNodeTest, FailedWriteStopsRecordingNotTheNode) {
  World world("/dev/full", config(), [] { return kPlenty; });
  for (Utime t = 0; t <= 3'000'000; t += kTickUs) world.tick(t);
  EXPECT_EQ(world.heartbeats_.back().status, std::int8_t{heartbeat_t::DEGRADED});
}

// A kill loses at most the current tick.
TEST_F(RecorderNodeTest, EachTickIsFlushedBeforeTheNext) {
  World world(path_, config(), [] { return kPlenty; });
  for (Utime t = 0; t <= 100'000; t += kTickUs) world.tick(t);
  EXPECT_GE(count("TICK"), 5u);
}

TEST_F(RecorderNodeTest, ReducedKeepsImagesAroundAStop) {
  World world(path_, config(true), [] { return kPlenty; });
  for (Utime t = 0; t <= 10'000'000; t += kTickUs) {
    if (t % 400'000 == 0) world.publish(channel::kLocCamLeft, world.made<image_t>(channel::kLocCamLeft, t));
    auto state = world.made<supervisor_state_t>(channel::kState, t);
    state.state = supervisor_state_t::STANDBY;
    if (t >= 5'000'000) state.state = supervisor_state_t::HAZARD_STOP;
    world.publish(channel::kState, state);
    world.tick(t);
  }
  world.close();
  std::set<std::int64_t> images;
  for (const ReadBack& event : read_back(path_))
    if (event.channel == channel::kLocCamLeft) images.insert(event.timestamp);
  // The first frame, and those from 1.0 s before to 0.5 s after the stop at 5 s.
  EXPECT_EQ(images, (std::set<std::int64_t>{0, 4'000'000, 4'400'000, 4'800'000, 5'200'000}));
  EXPECT_EQ(count(channel::kState), 501u);
}

}  // namespace
}  // namespace rover::recorder
