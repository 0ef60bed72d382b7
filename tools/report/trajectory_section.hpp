// The report's table of drift against the ground truth of a data set.
#pragma once

#include <string>

#include "tools/report/metrics.hpp"

namespace rover::report {

// HTML; empty where the run is no imported data set.
std::string trajectory_section(const Metrics& metrics);

}  // namespace rover::report
