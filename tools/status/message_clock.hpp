// Message time relative to wall time, from the last ticks. Wall time is an argument [s] of any monotonic clock.
#pragma once

#include <deque>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::status {

// Time interval over which rates are computed.
struct Window {
  Utime from = kNever;
  double message_s = 0.0;  // 0: fewer than two ticks
  double wall_s = 0.0;
};

class MessageClock {
 public:
  void tick(Utime utime, double wall_s);
  // Newest tick; kNever before the first.
  Utime now() const { return ticks_.empty() ? kNever : ticks_.back().utime; }
  // At most the last 5 s of message time. Wall time continues if ticks stop.
  Window window(double wall_s) const;
  double tick_age_s(double wall_s) const { return ticks_.empty() ? kNaN : wall_s - ticks_.back().wall_s; }
  // Age in message time; NaN if unknown.
  double age_s(Utime utime) const;

 private:
  struct Tick {
    Utime utime;
    double wall_s;
  };
  std::deque<Tick> ticks_;
};

}  // namespace rover::status
