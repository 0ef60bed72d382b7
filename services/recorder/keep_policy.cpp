#include "recorder/keep_policy.hpp"

#include <algorithm>

namespace rover::recorder {
namespace {

// Triggers older than this affect no later event; far above any bus latency.
constexpr Utime kTriggerMemory = 60'000'000;

}  // namespace

KeepPolicy::KeepPolicy(KeepConfig config)
    : config_(std::move(config)),
      before_(to_utime(config_.images_before_s)),
      after_(to_utime(config_.images_after_s)) {}

void KeepPolicy::trigger(Utime time) {
  triggers_.push_back(time);
  while (triggers_.front() < time - kTriggerMemory) triggers_.pop_front();
}

bool KeepPolicy::keep(const Event& event) const {
  if (!config_.reduced || !config_.bulk_channels.contains(event.channel)) return true;
  if ((event.seq - 1) % config_.image_interval == 0) return true;
  return std::any_of(triggers_.begin(), triggers_.end(), [&](Utime trigger) {
    return event.utime >= trigger - before_ && event.utime <= trigger + after_;
  });
}

}  // namespace rover::recorder
