// The list of faults in a scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/bus/faults.hpp"

namespace rover {

// Begins at a time, after a way, or with the first entry into a state of the supervisor: one of the three is set.
struct ScriptedFault {
  FaultOrder order;
  std::optional<double> at_s;           // of message time, from the first tick
  std::optional<double> at_m;           // of true way
  std::optional<std::int8_t> at_state;  // supervisor_state_t
};

// Throws ConfigError with file, line and key.
std::vector<ScriptedFault> read_faults(const Config& scenario);

}  // namespace rover
