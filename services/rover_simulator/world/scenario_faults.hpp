// Scripted faults of a scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/bus/faults.hpp"

namespace rover {

// Triggered by time, distance or first entry into a supervisor state; exactly one is set.
struct ScriptedFault {
  FaultRequest order;
  std::optional<double> at_s;           // message time since the first tick
  std::optional<double> after_m;        // true distance driven
  std::optional<std::int8_t> at_state;  // supervisor_state_t
};

// Throws ConfigError with file, line and key.
std::vector<ScriptedFault> read_faults(const Config& scenario);

}  // namespace rover
