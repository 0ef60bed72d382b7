#include "status/message_clock.hpp"

namespace rover::status {
namespace {

constexpr Utime kWindow = 5'000'000;

}  // namespace

void MessageClock::tick(Utime utime, double wall_s) {
  if (!ticks_.empty() && utime <= ticks_.back().utime) return;  // said again: a node was not heard
  ticks_.push_back({utime, wall_s});
  while (ticks_.front().utime < utime - kWindow) ticks_.pop_front();
}

Window MessageClock::window(double wall_s) const {
  if (ticks_.size() < 2) return {};
  return {ticks_.front().utime, to_seconds(ticks_.back().utime - ticks_.front().utime), wall_s - ticks_.front().wall_s};
}

double MessageClock::age_s(Utime utime) const {
  return ticks_.empty() || utime == kNever ? kNaN : to_seconds(now() - utime);
}

}  // namespace rover::status
