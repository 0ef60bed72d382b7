// The first field in which two messages of one channel differ.
#pragma once

#include <string>

#include "tools/replay/comparison.hpp"

namespace rover::replay {

// "position_m[1] is 0.25 in the log, 0.5 now"; empty where a side does not decode.
std::string field_difference(const Difference& difference);

}  // namespace rover::replay
