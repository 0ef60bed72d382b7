// The supervisor's states and levels by name, as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover {

// In the order of their values.
std::vector<std::string> state_names();
// Of supervisor_state_t; "?" where there is none.
std::string state_name(std::int8_t state);
std::string level_name(std::int8_t level);

}  // namespace rover
