// What every consumer of ELEVATION asks of it first.
#pragma once

#include <rover/elevation_t.hpp>
#include <string>

namespace rover {

// What is wrong with the message; empty: nothing. Single cells may be NaN.
std::string fault_of(const elevation_t& message);

}  // namespace rover
