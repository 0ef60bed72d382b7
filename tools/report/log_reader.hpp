// Reads a run's LCM event log into the judge's record.
#pragma once

#include <optional>

#include "common/bus/log_runs.hpp"
#include "tools/report/run_record.hpp"

namespace rover::report {

// Of a run that was cut or damaged, what is whole. Messages of the bus are counted until shortly before the end of the
// run, if it is known: which of the last ones still reach the log is a matter of chance.
RunRecord read_log(const LogRun& run, std::optional<double> run_s = std::nullopt);

}  // namespace rover::report
