#include "tools/launcher/drive_watch.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/wall_clock.hpp"
#include "tools/conform/checks.hpp"

namespace rover {
namespace {

constexpr size_t kCheckedAfterTicks = 150;  // 3 s: enough for several images, and start-up delays have passed

template <class Message>
bool decoded(const lcm::ReceiveBuffer* buffer, Message& message) {
  return decode_message(buffer->data, static_cast<int>(buffer->data_size), message);
}

std::string missing_channels(const conform::Received& received) {
  std::string missing;
  const auto look = [&missing](const char* channel, bool empty) {
    if (empty) missing += (missing.empty() ? "" : ", ") + std::string(channel);
  };
  look(channel::kImu, received.imu.empty());
  look(channel::kWheelState, received.wheels.empty());
  look(channel::kLocCamLeft, received.left.empty());
  look(channel::kLocCamRight, received.right.empty());
  return missing;
}

}  // namespace

DriveWatch::DriveWatch(lcm::LCM& lcm) {
  driver_.emplace(lcm, wall_s);
  lcm.subscribeFunction(
      channel::kTick, +[](const lcm::ReceiveBuffer*, const std::string&, DriveWatch* watch) { watch->on_tick(); },
      this);
  lcm.subscribeFunction(
      channel::kState,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, DriveWatch* watch) {
        supervisor_state_t state;
        if (decoded(buffer, state)) watch->on_state(state);
      },
      this);
  lcm.subscribeFunction(
      channel::kGroundCommand,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, DriveWatch* watch) {
        ground_command_t command;
        if (decoded(buffer, command)) watch->on_command(command);
      },
      this);
}

void DriveWatch::on_state(const supervisor_state_t& state) {
  states_at_goal_ = state.state == supervisor_state_t::GOAL_REACHED ? states_at_goal_ + 1 : 0;
}

void DriveWatch::on_command(const ground_command_t& command) {
  if (states_at_goal_ > 0 && command.kind == ground_command_t::STOP) stop_commanded_ = true;
}

void DriveWatch::on_tick() {
  ticks_received_ = true;
  ticked_ = Clock::now();
}

std::string DriveWatch::driver_problem() {
  if (!driver_ || driver_->received().ticks.size() < kCheckedAfterTicks) return "";
  const conform::Received received = driver_->take();
  driver_.reset();
  if (const std::string missing = missing_channels(received); !missing.empty())
    return "the driver publishes TICK but not " + missing + "; run ./rover conform for details";
  for (const conform::Lag& lag : conform::clock_lags(received))
    if (lag.median_s < conform::kMinLagS || lag.median_s > conform::kMaxLagS)
      return fmt::format(
          "{} comes {:.0f} ms {} TICK ({:.0f} to {:.0f} ms are allowed): synchronise the clocks of the "
          "drivers; run ./rover conform for details",
          lag.channel, 1e3 * std::abs(lag.median_s), lag.median_s > 0.0 ? "behind" : "ahead of",
          1e3 * conform::kMinLagS, 1e3 * conform::kMaxLagS);
  return "";
}

}  // namespace rover
