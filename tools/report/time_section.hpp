// The report's block on where the time of the drive went.
#pragma once

#include <string>

#include "tools/report/metrics.hpp"

namespace rover::report {

std::string time_section(const Metrics& m);

}  // namespace rover::report
