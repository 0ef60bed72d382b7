#include "tools/conform/trial_publisher.hpp"

#include <algorithm>
#include <rover/drive_permit_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <vector>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::conform {
namespace {}  // namespace

void TrialPublisher::publish(const Trial& trial, Utime now) {
  if (const auto output = trial.step(now)) std::visit([&](const auto& what) { publish(what, now); }, *output);
}

void TrialPublisher::publish(const Command& command, Utime now) {
  wheel_command_t message{};
  message.valid_until_utime = command.valid_until;
  std::copy(command.rate_radps.begin(), command.rate_radps.end(), message.drive_rate_radps);
  std::copy(command.steer_rad.begin(), command.steer_rad.end(), message.steer_angle_rad);
  message.header = streams_.next(channel::kWheelCommand, now, now);
  lcm_.publish(channel::kWheelCommand, &message);
}

// A driver that accepts this as a command would drive forward.
void TrialPublisher::publish(Damaged damaged, Utime now) {
  header_t header{};
  header.utime = header.release_utime = now;
  header.seq = 1;
  header.publisher = "conform";
  header.boot_id = streams_.boot_id();
  std::vector<std::uint8_t> bytes;
  if (damaged == Damaged::kForeign) {
    drive_permit_t permit{};
    permit.header = header;
    permit.valid_until_utime = now + kTickUs;
    bytes = encoded(permit);
  } else {
    wheel_command_t command{};
    command.header = header;
    command.valid_until_utime = now + 10 * kTickUs;
    std::fill(std::begin(command.drive_rate_radps), std::end(command.drive_rate_radps), 0.4);
    bytes = encoded(command);
    bytes.resize(bytes.size() - 13);
  }
  lcm_.publish(channel::kWheelCommand, bytes.data(), static_cast<unsigned int>(bytes.size()));
}

}  // namespace rover::conform
