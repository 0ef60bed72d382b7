#include "common/bus/node.hpp"

#include <gtest/gtest.h>

#include <rover/injection_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slip_t.hpp>

#include "common/bus/streams.hpp"
#include "common/core/frames.hpp"

namespace rover {
namespace {

// Test harness of one node: publishes ticks and inputs, records outputs.
class NodeTest : public testing::Test {
 protected:
  NodeTest() : bus_("memq://"), world_("world", 1) {
    // Not subscribe() with a member function: GCC 12's UndefinedBehaviorSanitizer takes LCM's call of it for a null
    // one.
    collect(channel::kDone, dones_);
    collect(channel::kPose, poses_);
  }

  template <class Message>
  void collect(const char* channel, std::vector<Message>& messages) {
    bus_.subscribeFunction(
        channel,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Message>* out) {
          Message message;
          if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) out->push_back(message);
        },
        &messages);
  }

  slip_t slip(double value, Utime utime, Utime release) {
    slip_t message{};
    message.header = world_.next(channel::kSlip, utime, release);
    message.wheel_mps = value;
    return message;
  }

  // Handles messages until the number of timeouts increases, at most for a generous time.
  bool falls_silent(Node& node, const int& timeouts) {
    const int before = timeouts;
    for (int i = 0; i < 50 && timeouts == before; ++i) node.handle(10);
    return timeouts > before;
  }

  void tick(Node& node, Utime utime, std::vector<stream_seq_t> streams = {}, std::int8_t mode = tick_t::LOCKSTEP) {
    tick_t tick;
    tick.header = world_.next(channel::kTick, utime, utime);
    tick.mode = mode;
    tick.members = {"node"};
    tick.member_count = 1;
    tick.streams = std::move(streams);
    tick.stream_count = static_cast<std::int32_t>(tick.streams.size());
    bus_.publish(channel::kTick, &tick);
    drain(node);
  }

  void drain(Node& node) {
    while (bus_.handleTimeout(0) > 0) node.handle(0);
    node.handle(0);
  }

  lcm::LCM bus_;
  StreamCounter world_;
  std::vector<done_t> dones_;
  std::vector<pose_t> poses_;
};

TEST_F(NodeTest, TicksOfTheClockThatStopAreNoticedOnce) {
  Node node({.name = "node"}, bus_);
  int timeouts = 0;
  node.on_tick_timeout([&] { ++timeouts; });
  tick(node, 20'000);  // in lockstep there is no tick timeout
  EXPECT_FALSE(falls_silent(node, timeouts));
  for (int round = 1; round <= 2; ++round) {
    tick(node, 20'000 * (round + 1), {}, tick_t::REALTIME);
    EXPECT_EQ(timeouts, round - 1);
    EXPECT_TRUE(falls_silent(node, timeouts));
    EXPECT_EQ(timeouts, round);
    EXPECT_FALSE(falls_silent(node, timeouts));
  }
}

TEST_F(NodeTest, ATickOfTheClockThatNamesNobodyIsForAll) {
  Node node({.name = "node"}, bus_);
  std::vector<Utime> steps;
  node.on_step([&](Utime now) { steps.push_back(now); });
  const auto nameless_tick = [&](Utime utime, std::int8_t mode) {
    tick_t tick{};
    tick.header = world_.next(channel::kTick, utime, utime);
    tick.mode = mode;
    bus_.publish(channel::kTick, &tick);
    drain(node);
  };
  nameless_tick(20'000, tick_t::LOCKSTEP);  // in lockstep only listed members take part
  EXPECT_TRUE(steps.empty());
  nameless_tick(40'000, tick_t::REALTIME);
  EXPECT_EQ(steps, std::vector<Utime>{40'000});
}

TEST_F(NodeTest, TakesInputsByReleaseNotByArrival) {
  Node node({.name = "node"}, bus_);
  std::vector<double> taken;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& message) { taken.push_back(message.wheel_mps); });
  slip_t first = slip(1.0, 0, 20'000);
  slip_t second = slip(2.0, 10, 40'000);
  bus_.publish(channel::kSlip, &second);
  bus_.publish(channel::kSlip, &first);
  tick(node, 20'000);
  EXPECT_EQ(taken, std::vector<double>{1.0});
  tick(node, 40'000);
  EXPECT_EQ(taken, (std::vector<double>{1.0, 2.0}));
}

TEST_F(NodeTest, ReportsDoneWithWhatItPublished) {
  Node node({.name = "node"}, bus_);
  node.on_step([&](Utime now) {
    pose_t pose{};
    node.publish(channel::kPose, pose, now);
  });
  tick(node, 20'000);
  ASSERT_EQ(dones_.size(), 1u);
  EXPECT_EQ(dones_[0].tick_utime, 20'000);
  ASSERT_EQ(dones_[0].stream_count, 1);
  EXPECT_EQ(dones_[0].streams[0].channel, "POSE");
  ASSERT_EQ(poses_.size(), 1u);
  EXPECT_EQ(poses_[0].header.release_utime, 40'000);
}

TEST_F(NodeTest, SlowWorkPromisesFirstAndReleasesAtThePromise) {
  Node node({.name = "node"}, bus_);
  size_t dones_before_work = 0;
  node.subscribe_slow<slip_t>(channel::kSlip, 120'000, [&](const slip_t& message) {
    bus_.handleTimeout(0);
    dones_before_work = dones_.size();
    pose_t pose{};
    node.publish(channel::kPose, pose, message.header.utime);
  });
  slip_t message = slip(1.0, 0, 20'000);
  bus_.publish(channel::kSlip, &message);
  tick(node, 20'000);
  EXPECT_EQ(dones_before_work, 1u);
  EXPECT_EQ(dones_[0].promise_utime, 140'000);
  ASSERT_EQ(poses_.size(), 1u);
  EXPECT_EQ(poses_[0].header.release_utime, 140'000);
}

// A node whose work on a frame takes five ticks, on a computer that needs `cpu_scale` times as long.
class SlowNode {
 public:
  SlowNode(lcm::LCM& bus, double cpu_scale) : node({.name = "node", .cpu_scale = cpu_scale}, bus) {
    for (const char* channel : {channel::kSlip, channel::kImu})
      node.subscribe_slow<slip_t>(channel, 100'000, [this](const slip_t& m) { taken.push_back(m.header.utime); });
  }
  Node node;
  std::vector<Utime> taken;
};

TEST_F(NodeTest, ANodeThatIsTooSlowGoesOnWithTheNewestFrame) {
  const auto taken_of = [&](double cpu_scale) {
    SlowNode slow(bus_, cpu_scale);
    for (Utime now = 20'000; now <= 600'000; now += 20'000) {
      slip_t message = slip(1.0, now, now);
      if (now % 120'000 == 0) bus_.publish(channel::kSlip, &message);
      tick(slow.node, now);
    }
    return slow.taken;
  };
  EXPECT_EQ(taken_of(1.0), (std::vector<Utime>{120'000, 240'000, 360'000, 480'000, 600'000}));
  EXPECT_EQ(taken_of(1.5), (std::vector<Utime>{120'000, 240'000, 360'000, 600'000}));
  EXPECT_EQ(taken_of(4.0), (std::vector<Utime>{120'000, 480'000}));
}

TEST_F(NodeTest, WhatComesLateOfTheFrameThatANodeWorksOnIsTaken) {
  SlowNode slow(bus_, 1.0);
  slip_t left = slip(1.0, 10'000, 20'000);
  bus_.publish(channel::kSlip, &left);
  tick(slow.node, 20'000);
  slip_t right{};
  right.header = world_.next(channel::kImu, 10'000, 40'000);
  bus_.publish(channel::kImu, &right);
  tick(slow.node, 40'000);
  EXPECT_EQ(slow.taken, (std::vector<Utime>{10'000, 10'000}));
}

TEST_F(NodeTest, OfFramesThatWaitTheNewestIsTaken) {
  SlowNode slow(bus_, 1.0);
  for (const Utime utime : {10'000, 12'000, 14'000}) {
    slip_t message = slip(1.0, utime, 20'000);
    bus_.publish(channel::kSlip, &message);
  }
  tick(slow.node, 20'000);
  EXPECT_EQ(slow.taken, std::vector<Utime>{14'000});
}

TEST_F(NodeTest, ByTheClockALateNodeGoesOnWithTheNewestTick) {
  Node node({.name = "node"}, bus_);
  std::vector<Utime> steps;
  node.on_step([&](Utime now) { steps.push_back(now); });
  for (const std::int8_t mode : {tick_t::REALTIME, tick_t::LOCKSTEP}) {
    const Utime begin = steps.empty() ? 0 : steps.back();
    for (int i = 1; i <= 3; ++i) {
      tick_t tick{};
      tick.header = world_.next(channel::kTick, begin + i * kTickUs, begin + i * kTickUs);
      tick.mode = mode;
      tick.members = {"node"};
      tick.member_count = 1;
      bus_.publish(channel::kTick, &tick);
      bus_.handleTimeout(0);  // received, but the node is late
    }
    node.handle(0);
  }
  EXPECT_EQ(steps, (std::vector<Utime>{60'000, 80'000, 100'000, 120'000}));
}

TEST_F(NodeTest, WaitsForWhatTheTickLists) {
  Node node({.name = "node"}, bus_);
  std::vector<double> taken;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& message) { taken.push_back(message.wheel_mps); });
  slip_t first = slip(1.0, 0, 20'000);
  bus_.publish(channel::kSlip, &first);
  tick(node, 20'000, world_.take_updated());
  slip_t second = slip(2.0, 10, 40'000);
  tick(node, 40'000, world_.take_updated());
  EXPECT_EQ(taken, std::vector<double>{1.0});
  bus_.publish(channel::kSlip, &second);
  drain(node);
  EXPECT_EQ(taken, (std::vector<double>{1.0, 2.0}));
}

TEST_F(NodeTest, ReportsHowManyListedMessagesItLost) {
  Node node({.name = "node"}, bus_);
  node.subscribe<slip_t>(channel::kSlip, [](const slip_t&) {});
  slip_t first = slip(1.0, 0, 20'000);
  bus_.publish(channel::kSlip, &first);
  tick(node, 20'000, world_.take_updated());
  slip(2.0, 10, 40'000);  // listed, but not published
  tick(node, 40'000, world_.take_updated());
  for (int i = 0; i < 1000 && dones_.size() < 2; ++i) node.handle(10);
  ASSERT_EQ(dones_.size(), 2u);
  EXPECT_EQ(dones_[0].lost, 0);
  EXPECT_EQ(dones_[1].lost, 1);
}

TEST_F(NodeTest, GapsRepeatsAndOldMessagesAreCountedAndNotTaken) {
  Node node({.name = "node"}, bus_);
  int taken = 0;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t&) { ++taken; });
  heartbeat_t heartbeat;
  bus_.subscribeFunction(
      channel::kHeartbeat,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, heartbeat_t* out) {
        out->decode(buffer->data, 0, static_cast<int>(buffer->data_size));
      },
      &heartbeat);
  slip_t one = slip(1.0, 1000, 20'000);
  slip_t lost = slip(2.0, 2000, 20'000);
  slip_t three = slip(3.0, 3000, 20'000);
  for (const slip_t* message : {&one, &three, &three}) bus_.publish(channel::kSlip, message);
  tick(node, 20'000);
  bus_.publish(channel::kSlip, &lost);
  tick(node, 200'000);
  EXPECT_EQ(taken, 2);
  ASSERT_EQ(heartbeat.input_count, 2);
  EXPECT_EQ(heartbeat.inputs[0].gaps, 1);
  EXPECT_EQ(heartbeat.inputs[0].out_of_order, 2);
  EXPECT_EQ(heartbeat.inputs[1].channel, channel::kTick);
  EXPECT_EQ(heartbeat.inputs[1].received, 2);
}

TEST_F(NodeTest, GarbageIsCountedAndChangesNothing) {
  Node node({.name = "node"}, bus_);
  int taken = 0;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t&) { ++taken; });
  const std::vector<std::uint8_t> noise(100, 0xA5);
  bus_.publish(channel::kSlip, noise.data(), 3);
  bus_.publish(channel::kSlip, noise.data(), 100);
  pose_t foreign{};
  foreign.header = world_.next(channel::kSlip, 0, 0);
  bus_.publish(channel::kSlip, &foreign);
  slip_t good = slip(1.0, 0, 20'000);
  std::vector<std::uint8_t> cut = encoded(good);
  bus_.publish(channel::kSlip, cut.data(), static_cast<unsigned int>(cut.size() - 4));
  tick(node, 20'000);
  EXPECT_EQ(taken, 0);
  EXPECT_EQ(node.age_s(channel::kSlip), kInfinity);
  slip_t next = slip(1.0, 0, 40'000);
  bus_.publish(channel::kSlip, &next);
  tick(node, 40'000);
  EXPECT_EQ(taken, 1);
}

TEST_F(NodeTest, ADamagedCopyDoesNotStandInForTheMessage) {
  Node node({.name = "node"}, bus_);
  std::vector<double> taken;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& message) { taken.push_back(message.wheel_mps); });
  slip_t good = slip(1.0, 0, 20'000);
  slip_t next = slip(2.0, 10, 20'000);
  std::vector<std::uint8_t> cut = encoded(good);
  bus_.publish(channel::kSlip, cut.data(), static_cast<unsigned int>(cut.size() - 4));
  bus_.publish(channel::kSlip, &good);
  bus_.publish(channel::kSlip, &next);
  tick(node, 20'000, world_.take_updated());
  EXPECT_EQ(taken, (std::vector<double>{1.0, 2.0}));
}

TEST_F(NodeTest, AMessageWithoutSequenceNumberIsNotTaken) {
  Node node({.name = "node"}, bus_);
  int taken = 0;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t&) { ++taken; });
  slip_t message = slip(1.0, 0, 20'000);
  message.header.seq = 0;
  bus_.publish(channel::kSlip, &message);
  testing::internal::CaptureStdout();
  tick(node, 20'000);
  EXPECT_EQ(taken, 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("BAD_MESSAGE channel=SLIP count=1 why=no sequence number"),
            std::string::npos);
}

// It would look fresh until then, and all later ones would be older.
TEST_F(NodeTest, AMessageMeasuredInTheFutureDoesNotEndItsStream) {
  Node node({.name = "node"}, bus_);
  std::vector<double> taken;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& message) { taken.push_back(message.wheel_mps); });
  slip_t future = slip(1.0, 3'600'000'000, 20'000);
  slip_t next = slip(2.0, 20'000, 40'000);
  testing::internal::CaptureStdout();
  bus_.publish(channel::kSlip, &future);
  tick(node, 20'000, world_.take_updated());
  EXPECT_EQ(node.age_s(channel::kSlip), kInfinity);
  bus_.publish(channel::kSlip, &next);
  tick(node, 40'000);
  EXPECT_EQ(taken, std::vector<double>{2.0});
  EXPECT_NE(
      testing::internal::GetCapturedStdout().find("BAD_MESSAGE channel=SLIP count=1 why=measured after its release"),
      std::string::npos);
}

TEST_F(NodeTest, AFlippedBitMakesNoMessageOfTheFuture) {
  Node node({.name = "node", .allow_injection = true}, bus_);
  int taken = 0;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& message) {
    ++taken;
    EXPECT_LE(message.header.utime, message.header.release_utime);
  });
  injection_t corrupt{};
  corrupt.fault = "corrupt";
  corrupt.target = channel::kSlip;
  corrupt.amount = 1.0;
  corrupt.until_utime = 3'600'000'000;
  corrupt.header = world_.next(channel::kInject, 0, 20'000);
  bus_.publish(channel::kInject, &corrupt);
  for (Utime t = 20'000; t <= 6'000'000; t += 20'000) {
    slip_t message = slip(1.0, t, t);
    bus_.publish(channel::kSlip, &message);
    tick(node, t);
  }
  EXPECT_GT(taken, 50);
}

TEST_F(NodeTest, AnswersATickThatIsGivenAgain) {
  Node node({.name = "node"}, bus_);
  int steps = 0;
  node.on_step([&](Utime) { ++steps; });
  tick(node, 20'000);
  tick(node, 20'000);
  EXPECT_EQ(steps, 1);
  EXPECT_EQ(dones_.size(), 2u);
}

TEST_F(NodeTest, StaysOutOfTicksThatDoNotNameIt) {
  Node node({.name = "other"}, bus_);
  int steps = 0;
  node.on_step([&](Utime) { ++steps; });
  tick(node, 20'000);
  EXPECT_EQ(steps, 0);
}

TEST_F(NodeTest, SaysBeforeLongWorkThatItIsBusy) {
  Node node({.name = "node"}, bus_);
  node.subscribe_slow<slip_t>(channel::kSlip, 120'000, [](const slip_t&) {});
  slip_t message = slip(1.0, 0, 20'000);
  bus_.publish(channel::kSlip, &message);
  tick(node, 20'000);
  ASSERT_EQ(dones_.size(), 2u);
  EXPECT_EQ(dones_[0].busy, 1);
  EXPECT_EQ(dones_[1].busy, 0);
}

TEST_F(NodeTest, AnInjectionHoldsForWhatIsTakenWithItWhateverArrivesFirst) {
  for (const bool injected_first : {true, false}) {
    Node node({.name = "node", .allow_injection = true}, bus_);
    std::vector<double> taken;
    node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& m) { taken.push_back(m.wheel_mps); });
    injection_t injection{};
    injection.header = world_.next(channel::kInject, 20'000, 20'000);
    injection.target = "SLIP.wheel_mps";
    injection.fault = "offset";
    injection.amount = 10.0;
    injection.from_utime = 20'000;
    injection.until_utime = 40'000;
    if (injected_first) bus_.publish(channel::kInject, &injection);
    slip_t at = slip(1.0, 20'000, 20'000);
    bus_.publish(channel::kSlip, &at);
    if (!injected_first) bus_.publish(channel::kInject, &injection);
    tick(node, 20'000);
    slip_t after = slip(2.0, 60'000, 60'000);
    bus_.publish(channel::kSlip, &after);
    tick(node, 60'000);
    EXPECT_EQ(taken, (std::vector<double>{11.0, 2.0}));
  }
}

TEST_F(NodeTest, ObeysNoInjectionUnlessItIsAllowed) {
  Node node({.name = "node"}, bus_);
  int taken = 0, injections = 0;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t&) { ++taken; });
  node.on_injection([&](const injection_t&) { ++injections; });
  injection_t injection{};
  injection.header = world_.next(channel::kInject, 20'000, 20'000);
  injection.target = "SLIP";
  injection.fault = "drop";
  injection.amount = 1.0;
  injection.until_utime = 1'000'000;
  bus_.publish(channel::kInject, &injection);
  slip_t message = slip(1.0, 20'000, 20'000);
  bus_.publish(channel::kSlip, &message);
  tick(node, 20'000);
  EXPECT_EQ(taken, 1);
  EXPECT_EQ(injections, 0);
}

TEST_F(NodeTest, TheRecordOfTheBusIsNotTouchedByFaults) {
  Node node({.name = "node", .allow_injection = true}, bus_);
  std::vector<std::string> heard;
  int injections = 0;
  node.subscribe_raw([&](const RawMessage& raw) { heard.push_back(raw.channel); }, find_channel_type);
  node.on_injection([&](const injection_t&) { ++injections; });
  injection_t injection{};
  injection.header = world_.next(channel::kInject, 20'000, 20'000);
  injection.target = "SLIP";
  injection.fault = "drop";
  injection.amount = 1.0;
  injection.until_utime = 1'000'000;
  bus_.publish(channel::kInject, &injection);
  slip_t message = slip(1.0, 20'000, 20'000);
  bus_.publish(channel::kSlip, &message);
  tick(node, 20'000);
  EXPECT_EQ(heard, (std::vector<std::string>{"INJECT", "SLIP", "TICK"}));
  EXPECT_EQ(injections, 1);
}

TEST_F(NodeTest, AProcessStartedAgainTakesNothingFromBeforeItsFirstTick) {
  Node node({.name = "node", .boot_id = 2}, bus_);
  std::vector<double> taken;
  node.subscribe<slip_t>(channel::kSlip, [&](const slip_t& message) { taken.push_back(message.wheel_mps); });
  slip_t before = slip(1.0, 60'000, 80'000);
  slip_t at = slip(2.0, 80'000, 100'000);
  bus_.publish(channel::kSlip, &before);
  bus_.publish(channel::kSlip, &at);
  tick(node, 100'000);
  EXPECT_EQ(taken, std::vector<double>{2.0});
}

TEST_F(NodeTest, OneThatIsGoneTakesNothingMoreFromTheBus) {
  int taken = 0;
  {
    Node node({.name = "node"}, bus_);
    node.subscribe<slip_t>(channel::kSlip, [&](const slip_t&) { ++taken; });
  }
  slip_t message = slip(1.0, 0, 20'000);
  bus_.publish(channel::kSlip, &message);
  Node next({.name = "node", .boot_id = 2}, bus_);
  tick(next, 20'000);
  EXPECT_EQ(taken, 0);
  EXPECT_EQ(dones_.size(), 1u);
}

TEST_F(NodeTest, AgeGrowsWithMessageTime) {
  Node node({.name = "node"}, bus_);
  node.subscribe<slip_t>(channel::kSlip, [](const slip_t&) {});
  slip_t message = slip(1.0, 0, 20'000);
  bus_.publish(channel::kSlip, &message);
  tick(node, 20'000);
  EXPECT_DOUBLE_EQ(node.age_s(channel::kSlip), 0.02);
  tick(node, 60'000);
  EXPECT_DOUBLE_EQ(node.age_s(channel::kSlip), 0.06);
}

}  // namespace
}  // namespace rover
