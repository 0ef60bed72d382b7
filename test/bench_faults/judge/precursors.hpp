// Rows that the same cause must trip before the row itself: lower limits of the same quantity, and the missing
// streams of a hanging service. Fixed before any run.
#pragma once

#include <set>
#include <string>

namespace rover::bench_faults {

std::set<std::string> precursors(const std::string& row);

}  // namespace rover::bench_faults
