#include "common/bus/state_names.hpp"

#include <algorithm>
#include <array>
#include <rover/supervisor_state_t.hpp>

namespace rover {
namespace {

constexpr const char* kUnknown = "?";  // there is no state with this value
constexpr std::array kStateNames = {"BOOT",   "STANDBY", "DRIVING",      "HAZARD_STOP", "REPAIRING", "SWEEPING",
                                    kUnknown, "PAUSED",  "GOAL_REACHED", "FAULT_STOP",  "SAFE",      "TELEOP"};
constexpr std::array kResponseNames = {"LOG",  "SLOW",          "STOP", "STOP_REPLAN", "RESTART_SERVICE",
                                       "SAFE", "STOP_BACKTRACK"};

}  // namespace

std::vector<std::string> state_names() {
  std::vector<std::string> names(kStateNames.begin(), kStateNames.end());
  std::erase(names, kUnknown);
  return names;
}

std::int8_t state_value(const std::string& name) {
  return static_cast<std::int8_t>(std::find(kStateNames.begin(), kStateNames.end(), name) - kStateNames.begin());
}

std::string state_name(std::int8_t state) {
  const auto index = static_cast<size_t>(state);
  return index < kStateNames.size() ? kStateNames[index] : kUnknown;
}

std::string response_name(std::int8_t response) {
  const auto index = static_cast<size_t>(response);
  return index < kResponseNames.size() ? kResponseNames[index] : kUnknown;
}

std::string level_name(std::int8_t level) {
  return level == supervisor_state_t::FULL ? "FULL" : "EFFICIENT";
}

}  // namespace rover
