#include "supervisor/monitor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/core/check.hpp"

namespace rover::supervisor {

Monitor::Monitor(MonitorRow row) : row_(std::move(row)) {
  ROVER_CHECK(row_.n >= 1 && row_.n <= row_.m && row_.m <= 64, row_.n, row_.m);
}

bool Monitor::step(Utime now, bool armed, const Reading& reading) {
  reading_ = reading;
  if (!armed) {
    history_ = 0;
    bad_since_ = good_since_ = last_data_utime_ = kNever;
    return set_active(false);
  }
  const bool bad = reading.condition != Condition::kFalse;
  if (reading.data_utime != last_data_utime_ || reading.condition == Condition::kStale) push_history(bad);
  last_data_utime_ = reading.data_utime;
  if (!bad) {
    if (good_since_ == kNever) good_since_ = now;
    if (active_) return !row_.latched && now - good_since_ >= to_utime(row_.clear_s) && set_active(false);
  } else {
    good_since_ = kNever;
  }
  if (std::popcount(history_) < row_.n) {
    bad_since_ = kNever;
    return false;
  }
  if (bad_since_ == kNever) bad_since_ = now;
  if (active_ || !bad || now - bad_since_ < to_utime(row_.persistence_s)) return false;
  visible_utime_ = reading.condition == Condition::kStale ? now : reading.data_utime;
  return set_active(true);
}

void Monitor::push_history(bool bad) {
  const std::uint64_t mask = row_.m == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << row_.m) - 1;
  history_ = ((history_ << 1) | static_cast<std::uint64_t>(bad)) & mask;
}

bool Monitor::unlatch(const Reading& reading) {
  reading_ = reading;
  if (reading_.condition != Condition::kFalse) return false;
  active_ = false;
  history_ = 0;
  bad_since_ = kNever;
  return true;
}

bool Monitor::set_active(bool active) {
  const bool changed = active_ != active;
  active_ = active;
  return changed;
}

Reading age_reading(Utime data_utime, Utime now, double limit_s) {
  Reading out{Condition::kStale, kInfinity, kInfinity, data_utime, kNaN};
  if (data_utime < 0) return out;
  out.value = out.data_age_s = to_seconds(now - data_utime);
  if (out.value <= limit_s) out.condition = Condition::kFalse;
  if (data_utime > now) {  // a wrong clock: the stream would look fresh until then
    out.condition = Condition::kInvalid;
    out.data_utime = now;
  }
  return out;
}

Reading flag_reading(bool bad, Utime data_utime, Utime now) {
  Reading out = age_reading(data_utime, now, kInfinity);
  out.value = bad ? 1.0 : 0.0;
  out.condition = bad ? Condition::kTrue : Condition::kFalse;
  return out;
}

Reading above_reading(double value, double limit, Utime data_utime, Utime now) {
  Reading out = flag_reading(value > limit, data_utime, now);
  out.value = value;
  if (std::isnan(value) && data_utime >= 0) out.condition = Condition::kInvalid;
  return out;
}

Reading below_reading(double value, double limit, Utime data_utime, Utime now) {
  Reading out = flag_reading(value < limit, data_utime, now);
  out.value = value;
  if (std::isnan(value) && data_utime >= 0) out.condition = Condition::kInvalid;
  return out;
}

}  // namespace rover::supervisor
