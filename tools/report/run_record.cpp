#include "tools/report/run_record.hpp"

namespace rover::report {

std::string state_name(State state) {
  static const std::array<const char*, 12> kNames = {"BOOT",         "STANDBY",    "DRIVING", "HAZARD_STOP",
                                                     "REPAIRING",    "SWEEPING",   "?",       "PAUSED",
                                                     "GOAL_REACHED", "FAULT_STOP", "SAFE",    "TELEOP"};
  const auto i = static_cast<size_t>(state);
  return i < kNames.size() ? kNames[i] : "UNKNOWN";
}

}  // namespace rover::report
