#include "tools/status/listener.hpp"

#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>
#include <rover/done_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/tick_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::status {
namespace {

bool always() {
  return true;
}

// An in-memory bus whose clock advances by 10 ms at each reading.
class Bus : public testing::Test {
 protected:
  Bus()
      : bus_("memq://"),
        world_("rover_simulator", 1),
        listener_(bus_, statistics_, [this] { return wall_s_ += 0.01; }) {}

  template <class Message>
  void publish(const std::string& channel, Message message, Utime utime) {
    message.header = world_.next(channel, utime, utime);
    bus_.publish(channel, &message);
  }
  void publish_bytes(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    bus_.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
  }
  Snapshot heard() {
    while (bus_.handleTimeout(0) > 0) {
    }
    return statistics_.snapshot({}, wall_s_);
  }

  double wall_s_ = 0.0;
  lcm::LCM bus_;
  StreamCounter world_;
  BusStatistics statistics_;
  Listener listener_;
};

TEST_F(Bus, AnyChannelIsCountedByItsHeader) {
  publish(channel::kTick, tick_t{}, 1'000'000);
  publish(channel::kSlip, slip_t{}, 1'000'000);
  publish("SOMEBODY_ELSES", slip_t{}, 1'000'000);
  publish(channel::kTick, tick_t{}, 1'020'000);
  const Snapshot s = heard();
  EXPECT_EQ(s.now, 1'020'000);
  EXPECT_NEAR(s.channels.at("SLIP").age_s, 0.02, 1e-9);
  EXPECT_TRUE(s.channels.contains("SOMEBODY_ELSES"));
}

TEST_F(Bus, StateFaultPermitAndHeartbeatAreRead) {
  publish(channel::kTick, tick_t{}, 5'000'000);
  supervisor_state_t state{};
  state.state = supervisor_state_t::FAULT_STOP;
  state.level = supervisor_state_t::FULL;
  state.faults = {"slip"};
  state.fault_count = 1;
  publish(channel::kState, state, 5'000'000);
  fault_t fault{};
  fault.id = "slip";
  fault.value = 0.9;
  fault.limit = 0.8;
  fault.condition = fault_t::TRUE_;
  fault.response = fault_t::STOP_REPLAN;
  fault.active = 1;
  publish(channel::kFault, fault, 4'000'000);
  drive_permit_t permit{};
  permit.reason = "FAULT_STOP";
  publish(channel::kDrivePermit, permit, 5'000'000);
  heartbeat_t beat{};
  beat.service = "stereo";
  beat.pid = 77;
  beat.status = heartbeat_t::DEGRADED;
  beat.inputs.resize(2);
  beat.inputs[0] = {"LOCCAM_LEFT", 10, 4'900'000, 2, 1, 0};
  beat.inputs[1] = {"LOCCAM_RIGHT", 0, -1, 0, 0, 4};
  beat.input_count = 2;
  publish(channel::kHeartbeat, beat, 5'000'000);

  const Snapshot s = heard();
  ASSERT_TRUE(s.state.has_value());
  EXPECT_EQ(s.state->state, "FAULT_STOP");
  EXPECT_EQ(s.state->level, "FULL");
  ASSERT_EQ(s.faults.size(), 1u);
  EXPECT_EQ(s.faults[0].report.value, 0.9);
  EXPECT_EQ(s.faults[0].report.condition, "TRUE");
  EXPECT_EQ(s.faults[0].report.response, "STOP_REPLAN");
  ASSERT_TRUE(s.permit.has_value());
  EXPECT_FALSE(s.permit->granted);
  const Heartbeat& heard_beat = *s.services.at("stereo").heartbeat;
  EXPECT_EQ(heard_beat.pid, 77);
  EXPECT_EQ(heard_beat.health, Health::kDegraded);
  EXPECT_EQ(heard_beat.gaps, 2);
  EXPECT_EQ(heard_beat.malformed, 1);
  EXPECT_EQ(heard_beat.out_of_order, 4);
  EXPECT_NEAR(s.channels.at("LOCCAM_LEFT").age_s, 0.1, 1e-9);
  EXPECT_FALSE(s.channels.contains("LOCCAM_RIGHT"));
}

TEST_F(Bus, DamagedMessagesAreCounted) {
  publish(channel::kTick, tick_t{}, 1'000'000);
  publish_bytes(channel::kState, {1, 2, 3});
  publish(channel::kFault, slip_t{}, 1'000'000);
  std::vector<std::uint8_t> cut(static_cast<size_t>(heartbeat_t{}.getEncodedSize()));
  heartbeat_t{}.encode(cut.data(), 0, static_cast<int>(cut.size()));
  cut.resize(cut.size() - 5);
  publish_bytes(channel::kHeartbeat, cut);
  const Snapshot s = heard();
  for (const char* channel : {"STATE", "FAULT", "HEARTBEAT"}) EXPECT_EQ(s.channels.at(channel).malformed, 1) << channel;
  EXPECT_FALSE(s.state.has_value());
  EXPECT_TRUE(s.faults.empty());
}

TEST_F(Bus, DoneIsNotListedAsChannel) {
  publish(channel::kDone, done_t{}, 1'000'000);
  publish_bytes("LCM_SELF_TEST", {1, 2, 3});
  EXPECT_TRUE(heard().channels.empty());
}

TEST_F(Bus, ListensUntilTheTimeIsOver) {
  publish(channel::kSlip, slip_t{}, 1'000'000);
  EXPECT_TRUE(listener_.listen_until(wall_s_ + 0.2, always));
  EXPECT_TRUE(statistics_.snapshot({}, wall_s_).channels.contains("SLIP"));
  int samples = 0;
  EXPECT_TRUE(listener_.listen_until(wall_s_ + 1e6, [&] { return ++samples < 3; }));
}

}  // namespace
}  // namespace rover::status
