// The runs of a log. A log that was joined from several, or whose recorder outlived a run, has more than one; message
// time decreases between them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/bus/event_log.hpp"

namespace rover {

// A longer time without TICK is a gap, which a replay skips.
inline constexpr Utime kLongestPause = 60'000'000;

struct LogPlace {
  size_t part = 0;  // of log_parts()
  std::int64_t offset = 0;
  auto operator<=>(const LogPlace&) const = default;
};

struct LogRun {
  std::string log;  // first part
  size_t number = 1;
  size_t of = 1;  // number of runs in the log
  LogPlace begin;
  LogPlace end;               // after its last record
  Utime first_tick = kNever;  // kNever: no TICK
  Utime last_tick = kNever;
  Utime gap_from = kNever;  // the longest gap beyond kLongestPause; kNever: none
  Utime gap_to = kNever;
  std::int64_t records = 0;
  std::int64_t skipped_bytes = 0;  // outside of intact records
  std::int64_t bad_ticks = 0;      // damaged, or of another type version
};

// A run begins where the time of TICK decreases, or after a gap with a new sequence. Its first messages are those
// released before its first TICK. `log_or_run`: a log with its parts, or the folder of a run. Throws ConfigError with
// one line if there is no intact record.
std::vector<LogRun> log_runs(const std::string& log_or_run);

// The run to read. `number` (--log-run) is required for a log of several runs; 0: not given. Throws ConfigError with
// one line if it is missing or does not exist.
LogRun choose_run(const std::string& log_or_run, int number = 0);

// One line for each defect or peculiarity of the log, with the remedy.
std::vector<std::string> remarks(const LogRun& run);
void print_remarks(const LogRun& run);  // on stderr

// Calls `take` for each intact record of the run.
void for_each_event(const LogRun& run, const std::function<void(const LogEvent&)>& take);

}  // namespace rover
