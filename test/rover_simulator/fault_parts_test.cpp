// Unit tests of fault script, process faults and command inbox.
#include <gtest/gtest.h>

#include <csignal>

#include "common/bus/channels.hpp"
#include "rover_simulator/command_inbox.hpp"
#include "rover_simulator/fault_script.hpp"
#include "rover_simulator/process_faults.hpp"

namespace rover {
namespace {

constexpr Utime kScriptStart = 1'000'000;

TEST(FaultScript, TriggersEachFaultOnceByTimeDistanceOrState) {
  std::vector<ScriptedFault> faults(3);
  faults[0].order.fault = "by_time";
  faults[0].at_s = 2.0;
  faults[1].order.fault = "by_distance";
  faults[1].after_m = 1.0;
  faults[2].order.fault = "by_state";
  faults[2].at_state = std::int8_t{2};
  FaultScript script(faults, kScriptStart);
  EXPECT_TRUE(script.take_due(kScriptStart + 1'980'000, 0.9).empty());
  EXPECT_EQ(script.take_due(kScriptStart + 2'000'000, 0.9).at(0).fault, "by_time");
  EXPECT_EQ(script.take_due(kScriptStart + 2'020'000, 1.0).at(0).fault, "by_distance");
  script.entered(1);
  EXPECT_TRUE(script.take_due(kScriptStart + 2'040'000, 2.0).empty());
  script.entered(2);
  script.entered(1);
  EXPECT_EQ(script.take_due(kScriptStart + 2'060'000, 2.0).at(0).fault, "by_state");
  EXPECT_TRUE(script.take_due(kScriptStart + 9'000'000, 9.0).empty());
}

TEST(ProcessFaults, RestartLoopKillsServiceAfterEachRejoin) {
  Barrier barrier({"stereo"});
  ProcessFaults faults;
  faults.order({"restart_loop", "stereo", 2.0});
  EXPECT_TRUE(faults.take_due(barrier).empty());  // not there yet
  for (int boot = 1; boot <= 2; ++boot) {
    const Utime t = boot * 2'000'000;
    barrier.ready("stereo", boot, 100 + boot);
    barrier.admit(t);
    const std::vector<ProcessSignal> signals = faults.take_due(barrier);
    ASSERT_EQ(signals.size(), 1u);
    EXPECT_EQ(signals[0].signal, SIGKILL);
    barrier.leave("stereo", Barrier::Cause::kDied, t, signals[0].absence);
    EXPECT_TRUE(faults.take_due(barrier).empty());
  }
  barrier.ready("stereo", 3, 103);
  barrier.admit(9'000'000);
  EXPECT_TRUE(faults.take_due(barrier).empty());
}

TEST(ProcessFaults, HungServiceIsAbsentLongerThanKilledOne) {
  Barrier barrier({"stereo"});
  barrier.ready("stereo", 1, 100);
  barrier.admit(0);
  ProcessFaults faults;
  faults.order({"hang", "stereo"});
  const std::vector<ProcessSignal> signals = faults.take_due(barrier);
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].signal, SIGSTOP);
  EXPECT_EQ(signals[0].absence, 3'000'000);
}

wheel_command_t command(std::int64_t seq, Utime utime) {
  wheel_command_t message{};
  message.header.seq = seq;
  message.header.utime = utime;
  message.header.release_utime = utime + kTickUs;
  message.header.publisher = "locomotion";
  return message;
}

TEST(CommandInbox, ReturnsNewestReleasedCommand) {
  CommandInbox<wheel_command_t> inbox(channel::kWheelCommand);
  for (int i = 1; i <= 3; ++i) inbox.add(command(i, i * kTickUs));
  EXPECT_FALSE(inbox.take(kTickUs, nullptr));
  EXPECT_EQ(inbox.take(3 * kTickUs, nullptr)->header.seq, 2);
  EXPECT_FALSE(inbox.take(3 * kTickUs, nullptr));
  EXPECT_EQ(inbox.take(4 * kTickUs, nullptr)->header.seq, 3);
}

TEST(CommandInbox, DropsDelayedCommandsOlderThanTheLast) {
  FaultInjector injector("rover_simulator");
  injection_t delay{};
  delay.fault = "delay";
  delay.target = "WHEEL_COMMAND";
  delay.amount = 0.1;
  delay.until_utime = kTickUs;
  ASSERT_TRUE(injector.inject(delay));
  CommandInbox<wheel_command_t> inbox(channel::kWheelCommand);
  inbox.add(command(1, kTickUs));
  inbox.add(command(2, 3 * kTickUs));
  EXPECT_FALSE(inbox.take(2 * kTickUs, &injector));
  EXPECT_EQ(inbox.take(4 * kTickUs, &injector)->header.seq, 2);
  EXPECT_FALSE(inbox.take(20 * kTickUs, &injector));
}

}  // namespace
}  // namespace rover
