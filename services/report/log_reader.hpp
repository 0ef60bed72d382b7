// Reads a run's LCM event log into the judge's record.
#pragma once

#include <optional>
#include <string>

#include "report/run_record.hpp"

namespace rover::report {

// All parts of it (event_log.hpp). Of a log that was cut or damaged, what is whole; one line on stderr says so. Throws
// ConfigError where nothing is. Messages of the bus are counted until shortly before the end of the run, if it is
// known: which of the last ones still reach the log is a matter of chance.
RunRecord read_log(const std::string& path, std::optional<double> run_s = std::nullopt);

}  // namespace rover::report
