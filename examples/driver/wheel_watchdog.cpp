#include "driver/wheel_watchdog.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace example {
namespace {

// A command never holds for longer, whatever it says: a sender whose clock has gone wrong must not drive the rover.
constexpr Utime kMostValidity = 500'000;

// By message time, which is the driver's own: boot_id and seq begin anew with each run of the stack.
bool newer(const rover::header_t& a, const rover::header_t& b) {
  return std::tie(a.utime, a.seq) > std::tie(b.utime, b.seq);
}

bool all_finite(const rover::wheel_command_t& command) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::all_of(std::begin(command.drive_rate_radps), std::end(command.drive_rate_radps), finite) &&
         std::all_of(std::begin(command.steer_angle_rad), std::end(command.steer_angle_rad), finite);
}

}  // namespace

std::optional<rover::wheel_command_t> WheelWatchdog::in_force(Utime t) {
  std::erase_if(waiting_, [&](const rover::wheel_command_t& command) {
    if (command.header.release_utime > t) return false;
    if (!newest_ || newer(command.header, newest_->header)) newest_ = command;
    return true;
  });
  if (!newest_ || expired(t) || newest_->valid_until_utime > t + kMostValidity || !all_finite(*newest_)) return {};
  return newest_;
}

}  // namespace example
