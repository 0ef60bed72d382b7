// Fault monitor with N-of-M persistence, clear time and latch. Stale and invalid readings count as bad.
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
  kStopBacktrack = 6
};

struct MonitorRow {
  std::string id;
  std::string quantity;
  double limit = 0.0;
  // Raised if n of the newest m measurements are bad for persistence_s. A stale reading counts once per tick.
  int n = 1;
  int m = 1;
  double persistence_s = 0.0;
  double clear_s = 1.0;  // clears after that time without a bad reading
  bool latched = false;  // cleared only by ground command, or when disarmed
  Response response = Response::kStop;
  double backtrack_limit = kInfinity;  // stop_backtrack: relaxed limit while backtracking, the recovery of that fault
  double slow_mps = kInfinity;         // slow: speed limit
  StateSet armed;
  std::optional<Level> level;  // armed only at that level
  bool stops = true;           // restart_service: the rover stops meanwhile

  bool stops_motion() const { return stops && response >= Response::kStop; }
};

struct Reading {
  Condition condition = Condition::kInvalid;
  double value = kNaN;
  double data_age_s = kInfinity;
  Utime data_utime = kNever;
  double limit = kNaN;  // set if the limit is not that of the row
};

class Monitor {
 public:
  // 1 <= n <= m <= 64.
  explicit Monitor(MonitorRow row);

  // Returns true if the fault was raised or cleared.
  bool step(Utime now, bool armed, const Reading& reading);
  // Ground command; returns false if the condition is still bad.
  bool unlatch(const Reading& reading);
  // After a restart.
  void restore_active() { active_ = true; }

  const MonitorRow& row() const { return row_; }
  bool active() const { return active_; }
  bool blocks_motion() const { return active_ && row_.stops_motion(); }
  const Reading& reading() const { return reading_; }
  double limit() const { return std::isnan(reading_.limit) ? row_.limit : reading_.limit; }
  // Time of the message that completed the persistence.
  Utime visible_utime() const { return visible_utime_; }

 private:
  void push_history(bool bad);
  bool set_active(bool active);

  MonitorRow row_;
  Reading reading_;
  std::uint64_t history_ = 0;  // bit 0: the newest measurement was bad
  Utime last_data_utime_ = kNever;
  Utime bad_since_ = kNever;
  Utime good_since_ = kNever;
  Utime visible_utime_ = kNever;
  bool active_ = false;
};

// Constructors of readings. An input that never arrived has infinite age; only age rows raise on it.
Reading age_reading(Utime data_utime, Utime now, double limit_s);
Reading flag_reading(bool bad, Utime data_utime, Utime now);
// Bad above (below) the limit, invalid if NaN.
Reading above_reading(double value, double limit, Utime data_utime, Utime now);
Reading below_reading(double value, double limit, Utime data_utime, Utime now);

}  // namespace rover::supervisor
