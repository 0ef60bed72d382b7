#include "tools/replay/player.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "../common/temp_folder.hpp"
#include "common/bus/bus_url.hpp"
#include "common/bus/node.hpp"
#include "made_log.hpp"

namespace rover::replay {
namespace {

constexpr char kBus[] = "udpm://239.255.76.67:21763?ttl=0&recv_buf_size=4194304";

// Service under test: publishes SLIP with the IMU's dt_s as slip ratio; from `odd_from` on a different value.
class Echo {
 public:
  explicit Echo(double odd_from = 1e9)
      : bus_(kBus), reports_(reports_url(kBus)), node_({.name = "echo"}, bus_, &reports_) {
    node_.subscribe<imu_t>(channel::kImu, [this, odd_from](const imu_t& imu) {
      slip_t slip{};
      slip.slip_ratio = imu.dt_s + (imu.dt_s >= odd_from ? 0.5 : 0.0);
      node_.publish(channel::kSlip, slip, node_.now());
    });
    thread_ = std::thread([this] { node_.run([this] { return running_.load(); }); });
  }
  ~Echo() {
    running_ = false;
    thread_.join();
  }

 private:
  lcm::LCM bus_;
  lcm::LCM reports_;
  Node node_;
  std::atomic<bool> running_{true};
  std::thread thread_;
};

class PlayerTest : public testing::Test {
 protected:
  PlayerTest() { const MadeLog log(path_, 200); }

  std::vector<StreamComparison> check(double odd_from) {
    const Echo echo(odd_from);
    RecordedLog log(path_);
    lcm::LCM bus(kBus), reports(reports_url(kBus));
    Comparison comparison;
    Player player({.live = {"echo"}, .speed = 0.0}, log, bus, reports, &comparison);
    const PlayResult played = player.play({});
    EXPECT_EQ(played.first, MadeLog::tick_time(1));
    EXPECT_EQ(played.last, MadeLog::tick_time(200));
    return comparison.finish(played.last);
  }

  testing_support::TempFolder folder_;
  std::string path_ = folder_.file("made.lcm");
};

TEST_F(PlayerTest, IdenticalLiveServiceShowsNoDifference) {
  const auto results = check(1e9);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].publisher, "echo");
  EXPECT_EQ(results[0].identical, 199);
  EXPECT_FALSE(results[0].first);
}

TEST_F(PlayerTest, DifferentLiveServiceIsDetected) {
  const auto first = first_of(check(120.0));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->name.seq, 120);
  EXPECT_EQ(first->kind, Difference::Kind::kContent);
}

// What its later processes published is played from the log.
TEST_F(PlayerTest, ServiceThatEndedInTheLogIsLiveUntilThen) {
  { const MadeLog ended(path_, 200, "w", 0, 0, 100); }
  const Echo echo;
  RecordedLog log(path_);
  EXPECT_EQ(log.left(), (std::map<std::string, Utime>{{"echo", MadeLog::tick_time(100)}}));
  lcm::LCM bus(kBus), reports(reports_url(kBus));
  std::vector<double> heard;
  bus.subscribeFunction(
         channel::kSlip,
         +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<double>* out) {
           slip_t slip{};
           if (decode_message(buffer->data, static_cast<int>(buffer->data_size), slip)) out->push_back(slip.slip_ratio);
         },
         &heard)
      ->setQueueCapacity(0);
  Comparison comparison;
  PlayerOptions options{.live = {"echo"}, .speed = 0.0};
  options.ended["echo"] = {1, MadeLog::tick_time(100), MadeLog::tick_time(100)};
  Player player(options, log, bus, reports, &comparison);
  const PlayResult played = player.play({});
  const auto results = comparison.finish(played.last);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].identical, 99);
  EXPECT_FALSE(results[0].first);
  while (bus.handleTimeout(100) > 0) {
  }
  ASSERT_EQ(heard.size(), 99U + 80U);
  EXPECT_EQ(heard[98], 99.0);
  EXPECT_EQ(heard[99], 1120.0);
}

// Everything that is published on an in-memory bus when a log is played without live services.
struct Heard {
  std::vector<std::string> channels;
  std::vector<Utime> ticks;
};

Heard play_alone(RecordedLog& log, const PlayerOptions& options, PlayerHooks hooks = {}) {
  lcm::LCM bus("memq://");
  Heard received;
  bus.subscribeFunction(
      ".*",
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Heard* out) {
        out->channels.push_back(channel);
        tick_t tick{};
        if (channel == channel::kTick && decode_message(buffer->data, static_cast<int>(buffer->data_size), tick))
          out->ticks.push_back(tick.header.utime);
      },
      &received);
  Player player(options, log, bus, bus, nullptr);
  player.play(hooks);
  while (bus.handleTimeout(0) > 0) {
  }
  return received;
}

TEST_F(PlayerTest, WithoutLiveServicesMessagesAreAsRecorded) {
  RecordedLog log(path_);
  const Heard received = play_alone(log, {.speed = 0.0});
  ASSERT_EQ(received.channels.size(), 3 * 200 - 1U);
  EXPECT_EQ(received.channels[2], channel::kImu);
  EXPECT_EQ(received.channels[3], channel::kSlip);
  EXPECT_EQ(received.channels[4], channel::kTick);
  EXPECT_EQ(received.ticks, log.ticks());
}

TEST_F(PlayerTest, PlaysFromAndUntil) {
  RecordedLog log(path_);
  const Heard received =
      play_alone(log, {.speed = 0.0, .from = MadeLog::tick_time(50), .until = MadeLog::tick_time(60)});
  ASSERT_EQ(received.ticks.size(), 11U);
  EXPECT_EQ(received.ticks.front(), MadeLog::tick_time(50));
}

// Paced by the clock: without the jump this test would take days.
TEST_F(PlayerTest, GapOfDaysIsSkippedInOneStep) {
  { const MadeLog jumps(path_, 10, "w", 6, 3 * Utime{86'400'000'000}); }
  RecordedLog log(path_);
  EXPECT_EQ(play_alone(log, {.speed = 1.0}).ticks, log.ticks());
  const Echo echo;
  lcm::LCM bus(kBus), reports(reports_url(kBus));
  Comparison comparison;
  Player player({.live = {"echo"}, .speed = 1.0}, log, bus, reports, &comparison);
  const PlayResult played = player.play({});
  EXPECT_EQ(played.last, log.ticks().back());
  EXPECT_FALSE(played.quit);
}

TEST_F(PlayerTest, KeysSeekBothDirectionsAndQuit) {
  { const MadeLog longer(path_, 2000); }
  RecordedLog log(path_);
  int count = 0;
  PlayerHooks hooks;
  // The keys arrive before the played ticks 3, 4, 5 ...
  hooks.key = [&]() -> std::optional<Key> {
    ++count;
    if (count == 3) return Key::kForward;
    if (count == 6) return Key::kBack;
    if (count == 9) return Key::kQuit;
    return std::nullopt;
  };
  const std::vector<Utime> ticks = play_alone(log, {.speed = 0.0}, hooks).ticks;
  ASSERT_GE(ticks.size(), 4U);
  ASSERT_LE(ticks.size(), 8U);
  EXPECT_EQ(ticks[1], MadeLog::tick_time(2));
  EXPECT_EQ(ticks[2], MadeLog::tick_time(3) + 10'000'000);
  EXPECT_LT(ticks.back(), 2'000'000);
}

}  // namespace
}  // namespace rover::replay
