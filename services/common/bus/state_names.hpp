// Names of the supervisor's states, levels and fault responses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover {

std::vector<std::string> state_names();
// Its value in supervisor_state_t; the name is one of state_names().
std::int8_t state_value(const std::string& name);
// Of supervisor_state_t; "?" for an unknown value.
std::string state_name(std::int8_t state);
std::string level_name(std::int8_t level);
// Of fault_t: LOG, SLOW ...; "?" if there is none.
std::string response_name(std::int8_t response);

}  // namespace rover
