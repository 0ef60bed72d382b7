// Reads a run's LCM event log into the judge's record.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "report/run_record.hpp"

namespace rover::report {

struct LogEvent {
  std::string channel;
  const std::uint8_t* data = nullptr;
  int size = 0;
};

struct LogLength {
  std::int64_t records = 0;     // whole ones
  std::int64_t left_bytes = 0;  // after the last of them: the log has been cut
};

// Calls `take` for each whole record; a cut last one ends the log. Throws ConfigError where there is no log.
LogLength for_each_event(const std::string& path, const std::function<void(const LogEvent&)>& take);

// Of a log that was cut, what is whole; one line on stderr says so. Throws ConfigError where nothing is. Messages of
// the bus are counted until shortly before the end of the run, if it is known: which of the last ones still reach the
// log is a matter of chance.
RunRecord read_log(const std::string& path, std::optional<double> run_s = std::nullopt);

}  // namespace rover::report
