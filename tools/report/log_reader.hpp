// Reads the LCM log of a run into a run record.
#pragma once

#include <optional>

#include "common/bus/log_runs.hpp"
#include "tools/report/run_record.hpp"

namespace rover::report {

// Skips damaged parts. `run_s`: duration of the run, from its first TICK. Bus messages are counted until shortly before
// its end: the last ones may miss the log.
RunRecord read_log(const LogRun& run, std::optional<double> run_s = std::nullopt);

}  // namespace rover::report
