// Rows of a benchmark: one metrics.json per line.
#pragma once

#include <string>
#include <vector>

#include "tools/report/bench_table.hpp"

namespace rover::report {

// Throws ConfigError with file and line if a line is not the metrics of a run.
std::vector<BenchRow> parse_rows(const std::string& text, const std::string& file);

// Processor model and number of cores, as reported by the operating system.
BenchContext this_machine();

}  // namespace rover::report
