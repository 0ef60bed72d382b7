#include "locomotion/node.hpp"

#include <string>

#include "common/bus/convert.hpp"
#include "locomotion/convert.hpp"

namespace rover::locomotion {
namespace {

const char* text_of(LocomotionState state) {
  if (state == LocomotionState::kHolding) return "holding";
  return state == LocomotionState::kDriving ? "driving" : "aligning";
}

}  // namespace

LocomotionNode::LocomotionNode(Node& node, const NodeConfig& config)
    : node_(node),
      validity_(to_utime(config.command_validity_s)),
      steering_slow_rad_(config.locomotion.steering_slow_rad),
      locomotion_(config.locomotion, config.vehicle) {
  node_.subscribe<motion_command_t>(channel::kMotionCommand,
                                    [this](const motion_command_t& m) { command_ = command_from(m); });
  node_.subscribe<drive_permit_t>(channel::kDrivePermit, [this](const drive_permit_t& m) { permit_ = permit_from(m); });
  node_.subscribe<wheel_state_t>(channel::kWheelState, [this](const wheel_state_t& m) { wheels_ = reading_from(m); });
  node_.on_step([this](Utime now) { step(now); });
  node_.on_tick_timeout([this] { stop(); });
}

void LocomotionNode::step(Utime now) {
  const WheelCommand command = locomotion_.step(now, command_, permit_, wheels_);
  wheel_command_t message{};
  message.valid_until_utime = command.valid ? now + validity_ : now;
  setpoints_to(command.wheels, message);
  node_.publish(channel::kWheelCommand, message, now);
  report(command);
}

// Without ticks the time is unknown, so no lease can be checked: step without a permit.
void LocomotionNode::stop() {
  wheel_command_t message{};
  message.valid_until_utime = node_.now();
  setpoints_to(locomotion_.step(node_.now(), command_, {}, wheels_).wheels, message);
  node_.publish(channel::kWheelCommand, message, node_.now());
}

void LocomotionNode::report(const WheelCommand& command) {
  const bool lagging = command.steering_error_rad > steering_slow_rad_ && command.state == LocomotionState::kDriving;
  if (lagging != steering_lagging_) {
    steering_lagging_ = lagging;
    node_.set_status(lagging ? heartbeat_t::DEGRADED : heartbeat_t::OK, lagging ? "steering behind its setpoint" : "");
  }
  if (command.state == state_) return;
  state_ = command.state;
  node_.log("INFO", std::string("LOCOMOTION state=") + text_of(state_) + " lease=" + (command.lease ? "1" : "0"));
}

}  // namespace rover::locomotion
