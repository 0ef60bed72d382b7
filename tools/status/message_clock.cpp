#include "tools/status/message_clock.hpp"

namespace rover::status {
namespace {

constexpr Utime kWindow = 5'000'000;

}  // namespace

void MessageClock::tick(Utime utime, double wall_s) {
  if (utime == kNever || utime <= now()) return;  // said again: a node was not heard
  ticks_.push_back({utime, wall_s});
  while (ticks_.front().utime < utime - kWindow) ticks_.pop_front();
}

Window MessageClock::window(double wall_s) const {
  if (ticks_.size() < 2) return {};
  return {ticks_.front().utime, to_seconds(ticks_.back().utime - ticks_.front().utime), wall_s - ticks_.front().wall_s};
}

double MessageClock::age_s(Utime utime) const {
  if (ticks_.empty() || utime == kNever) return kNaN;
  const Utime age = now() - utime;
  // What the world measures for a tick goes out just before it. What is of a later future is shown as such.
  return age < 0 && age >= -kTickUs ? 0.0 : to_seconds(age);
}

}  // namespace rover::status
