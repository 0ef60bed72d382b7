// Rows of a bench: one metrics.json on each line.
#pragma once

#include <string>
#include <vector>

#include "tools/report/bench_table.hpp"

namespace rover::report {

// Throws ConfigError naming file and line where a line is not a run's figures.
std::vector<BenchRow> parse_rows(const std::string& text, const std::string& file);

// Model of the processor and number of cores, as the operating system names them.
BenchContext this_machine();

}  // namespace rover::report
