#include "tools/status/message_clock.hpp"

namespace rover::status {
namespace {

constexpr Utime kWindow = 5'000'000;

}  // namespace

void MessageClock::tick(Utime utime, double wall_s) {
  if (utime == kNever || utime <= now()) return;  // tick repeated for a late node
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
  // The world publishes measurements just before their tick: clamp. Times further in the future are shown.
  return age < 0 && age >= -kTickUs ? 0.0 : to_seconds(age);
}

}  // namespace rover::status
