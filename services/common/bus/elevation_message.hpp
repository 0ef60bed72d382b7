// Validity check for every consumer of ELEVATION.
#pragma once

#include <rover/elevation_t.hpp>
#include <string>

namespace rover {

// Error text; empty if the message is valid. Single cells may be NaN.
std::string fault_of(const elevation_t& message);

}  // namespace rover
