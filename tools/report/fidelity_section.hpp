// HTML: consistency of the pose and fidelity of the maps.
#pragma once

#include <string>

#include "tools/report/metrics.hpp"

namespace rover::report {

// Empty without truth.
std::string fidelity_section(const Metrics& m);

}  // namespace rover::report
