// Time from which a row's fault is visible: the message with which n of the last m measurements are bad for the
// duration of the persistence; without messages, when the age has exceeded the limit for that long.
#pragma once

#include <deque>

#include "common/core/time.hpp"
#include "test/bench_faults/judge/row_table.hpp"

namespace rover::bench_faults {

// Value of a row's quantity at a tick.
struct Measurement {
  Utime utime = kNever;    // of its newest message; kNever: none yet
  Utime release = kNever;  // earliest time at which it could be known
  bool bad = false;
  bool is_age = false;  // the quantity is an age
};

struct Visible {
  Utime utime = kNever;  // kNever: not visible
  Utime release = kNever;
};

class Visibility {
 public:
  explicit Visibility(const Row& row) : row_(row) {}

  Visible step(Utime tick, bool armed, const Measurement& measured) {
    if (!armed) {
      window_.clear();
      judged_ = bad_since_ = kNever;
      return {};
    }
    return measured.is_age ? step_age(tick, measured) : step_value(measured);
  }

 private:
  Visible step_age(Utime tick, const Measurement& measured) const {
    const Utime at = measured.utime + to_utime(row_.limit + row_.persistence_s);
    return measured.utime != kNever && tick > at ? Visible{at, at} : Visible{};
  }
  Visible step_value(const Measurement& measured) {
    if (measured.utime == kNever) return {};
    if (measured.utime != judged_) {
      window_.push_back(measured.bad);
      if (static_cast<int>(window_.size()) > row_.m) window_.pop_front();
    }
    judged_ = measured.utime;
    int bad = 0;
    for (const bool one : window_) bad += one;
    if (bad < row_.n) {
      bad_since_ = kNever;
      return {};
    }
    if (bad_since_ == kNever) bad_since_ = measured.utime;
    const bool lasts = measured.utime - bad_since_ >= to_utime(row_.persistence_s);
    return measured.bad && lasts ? Visible{measured.utime, measured.release} : Visible{};
  }

  Row row_;
  std::deque<bool> window_;
  Utime judged_ = kNever;
  Utime bad_since_ = kNever;
};

}  // namespace rover::bench_faults
