#include "supervisor/monitor.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {

bool Monitor::step(Utime now, State state, const Reading& reading) {
  reading_ = reading;
  if (!row_.armed.has(state)) {
    bad_since_ = good_since_ = kNever;
    return set(false);
  }
  if (reading.condition == Condition::kFalse) {
    bad_since_ = kNever;
    if (good_since_ == kNever) good_since_ = now;
    return !row_.latched && now - good_since_ >= to_utime(row_.clear_s) && set(false);
  }
  good_since_ = kNever;
  if (bad_since_ == kNever) bad_since_ = now;
  if (standing_ || now - bad_since_ < to_utime(row_.persistence_s)) return false;
  visible_utime_ = reading.condition == Condition::kTrue ? reading.data_utime : now;
  return set(true);
}

bool Monitor::unlatch() {
  if (reading_.condition != Condition::kFalse) return false;
  standing_ = false;
  return true;
}

bool Monitor::set(bool standing) {
  const bool changed = standing_ != standing;
  standing_ = standing;
  return changed;
}

Reading age_reading(Utime data_utime, Utime now, double limit_s) {
  Reading out{Condition::kStale, kInfinity, kInfinity, data_utime, kNaN};
  if (data_utime < 0) return out;
  out.value = out.data_age_s = to_seconds(now - data_utime);
  if (out.value <= limit_s) out.condition = Condition::kFalse;
  return out;
}

Reading flag_reading(bool bad, Utime data_utime, Utime now) {
  Reading out = age_reading(data_utime, now, kInfinity);
  out.value = bad ? 1.0 : 0.0;
  // That nothing came is the concern of the row that watches the age.
  out.condition = bad ? Condition::kTrue : Condition::kFalse;
  return out;
}

Reading above_reading(double value, double limit, Utime data_utime, Utime now) {
  Reading out = flag_reading(value > limit, data_utime, now);
  out.value = value;
  if (std::isnan(value)) out.condition = Condition::kInvalid;
  return out;
}

}  // namespace rover::supervisor
