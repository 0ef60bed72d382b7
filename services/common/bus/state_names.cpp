#include "common/bus/state_names.hpp"

#include <array>
#include <rover/supervisor_state_t.hpp>

namespace rover {
namespace {

constexpr std::array kStateNames = {"BOOT", "STANDBY", "DRIVING",      "HAZARD_STOP", "REPAIRING", "SWEEPING",
                                    "?",    "PAUSED",  "GOAL_REACHED", "FAULT_STOP",  "SAFE",      "TELEOP"};
constexpr std::array kResponseNames = {"LOG",  "SLOW",          "STOP", "STOP_REPLAN", "RESTART_SERVICE",
                                       "SAFE", "STOP_BACKTRACK"};

}  // namespace

std::vector<std::string> state_names() {
  return {kStateNames.begin(), kStateNames.end()};
}

std::string state_name(std::int8_t state) {
  const auto index = static_cast<size_t>(state);
  return index < kStateNames.size() ? kStateNames[index] : "?";
}

std::string response_name(std::int8_t response) {
  const auto index = static_cast<size_t>(response);
  return index < kResponseNames.size() ? kResponseNames[index] : "?";
}

std::string level_name(std::int8_t level) {
  return level == supervisor_state_t::FULL ? "FULL" : "EFFICIENT";
}

}  // namespace rover
