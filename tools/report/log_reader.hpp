// Reads the LCM log of a run into a run record.
#pragma once

#include <optional>

#include "common/bus/log_runs.hpp"
#include "tools/report/run_record.hpp"

namespace rover::report {

// Skips damaged parts. Bus messages are counted until shortly before the end of the run: the last ones may miss the
// log.
RunRecord read_log(const LogRun& run, std::optional<double> run_s = std::nullopt);

}  // namespace rover::report
