// One row of fault detection: a reading that must stay bad to raise, and good to clear.
// Not known is not healthy: a stale or invalid reading raises like a bad one.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

// Values as in lcmtypes/fault_t.lcm.
enum class Condition : std::int8_t { kFalse = 0, kTrue = 1, kStale = 2, kInvalid = 3 };
enum class Response : std::int8_t {
  kLog = 0,
  kSlow = 1,
  kStop = 2,
  kStopReplan = 3,
  kRestartService = 4,
  kSafe = 5,
  kStopRetreat = 6
};

struct MonitorRow {
  std::string id;
  std::string quantity;
  double limit = 0.0;
  // Raised when n of the newest m measurements are bad, for that long. What is stale counts once a tick.
  int n = 1;
  int m = 1;
  double persistence_s = 0.0;
  double clear_s = 1.0;  // good for that long
  bool latched = false;  // cleared by the ground, or where the row is not armed
  Response response = Response::kStop;
  double back_limit = kInfinity;  // stop_retreat: the limit on a way back, which is what ends such a fault
  double slow_mps = kInfinity;    // slow: the most that is driven then
  StateSet armed;
  std::optional<Level> level;  // armed in that level alone
  bool stops = true;           // restart_service: the rover stands meanwhile
};

struct Reading {
  Condition condition = Condition::kInvalid;
  double value = kNaN;
  double data_age_s = kInfinity;
  Utime data_utime = kNever;
  double limit = kNaN;  // where the row's is not a constant
};

class Monitor {
 public:
  // 1 <= n <= m <= 64.
  explicit Monitor(MonitorRow row);

  // True where the fault was raised or cleared.
  bool step(Utime now, bool armed, const Reading& reading);
  // Unlatches by ground command; false where the condition still holds.
  bool unlatch(const Reading& reading);
  // As it stood before a restart.
  void restore_standing() { standing_ = true; }

  const MonitorRow& row() const { return row_; }
  bool standing() const { return standing_; }
  bool blocks() const { return standing_ && row_.stops && row_.response >= Response::kStop; }
  const Reading& reading() const { return reading_; }
  double limit() const { return std::isnan(reading_.limit) ? row_.limit : reading_.limit; }
  // utime of the message that completed the persistence.
  Utime visible_utime() const { return visible_utime_; }

 private:
  void remember(bool bad);
  bool set(bool standing);

  MonitorRow row_;
  Reading reading_;
  std::uint64_t history_ = 0;  // bit 0: the newest measurement was bad
  Utime judged_utime_ = kNever;
  Utime bad_since_ = kNever;
  Utime good_since_ = kNever;
  Utime visible_utime_ = kNever;
  bool standing_ = false;
};

// Readings of the usual kinds. An input that never came is as old as can be; that it did not is the concern of the row
// that watches its age, the others find nothing in it.
Reading age_reading(Utime data_utime, Utime now, double limit_s);
Reading flag_reading(bool bad, Utime data_utime, Utime now);
// Bad above (below) the limit, invalid where not a number.
Reading above_reading(double value, double limit, Utime data_utime, Utime now);
Reading below_reading(double value, double limit, Utime data_utime, Utime now);

}  // namespace rover::supervisor
