// Report table of drift against the ground truth of a data set.
#pragma once

#include <string>

#include "tools/report/metrics.hpp"

namespace rover::report {

// HTML; empty if the run is not an imported data set.
std::string trajectory_section(const Metrics& metrics);

}  // namespace rover::report
