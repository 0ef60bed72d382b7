// Reads a run's LCM event log into the judge's record.
#pragma once

#include <functional>
#include <string>

#include "report/run_record.hpp"

namespace rover::report {

struct LogEvent {
  std::string channel;
  const std::uint8_t* data = nullptr;
  int size = 0;
};

// Calls `take` for each whole record; a cut last one ends the log. Throws ConfigError where there is no log.
// Returns the number of records.
std::int64_t for_each_event(const std::string& path, const std::function<void(const LogEvent&)>& take);

RunRecord read_log(const std::string& path);

}  // namespace rover::report
