// The runs that a log holds. Most hold one; a log that was put together from several ones, or whose recorder outlived a
// run, holds more, and message time falls between them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/bus/event_log.hpp"

namespace rover {

// Message time without a TICK that is a gap and no pause: nobody waits for it.
inline constexpr Utime kLongestPause = 60'000'000;

struct LogPlace {
  size_t part = 0;  // of log_parts()
  std::int64_t offset = 0;
  auto operator<=>(const LogPlace&) const = default;
};

struct LogRun {
  std::string log;  // file, the first of its parts
  size_t number = 1;
  size_t of = 1;  // so many runs in the log
  LogPlace begin;
  LogPlace end;               // behind its last record
  Utime first_tick = kNever;  // kNever: no TICK
  Utime last_tick = kNever;
  Utime gap_from = kNever;  // the longest gap beyond kLongestPause; kNever: none
  Utime gap_to = kNever;
  std::int64_t records = 0;
  std::int64_t left_bytes = 0;  // that belong to no whole record
  std::int64_t bad_ticks = 0;   // TICKs that are none of this build's type
};

// A run begins where TICK falls, or where it leaves a gap and is counted anew; its first messages are those that are
// released before its first TICK. `log_or_run`: a log with its parts, or the folder of a run. Throws ConfigError with
// one line where there is no whole record.
std::vector<LogRun> log_runs(const std::string& log_or_run);

// The run that a tool is to read: of several, `number` (--log-run) names it. 0: none was named. Throws ConfigError with
// one line where it has to be, or where there is no such run.
LogRun choose_run(const std::string& log_or_run, int number = 0);

// One line for each thing that is not as in a whole log of one run, the way on included.
std::vector<std::string> remarks(const LogRun& run);
void print_remarks(const LogRun& run);  // on stderr

// Calls `take` for each whole record of the run.
void for_each_event(const LogRun& run, const std::function<void(const LogEvent&)>& take);

}  // namespace rover
