#include "supervisor/state_machine.hpp"

#include <algorithm>
#include <sstream>

namespace rover::supervisor {
namespace {

using enum State;
using F = Fact;

constexpr StateSet kUnderWay = {kDriving, kHazardStop, kRepairing};
constexpr StateSet kAllButSafe = {kBoot,       kStandby, kDriving,     kHazardStop, kRepairing, kSweeping,
                                  kCorrecting, kPaused,  kGoalReached, kFaultStop,  kTeleop};

// The first row that fits decides: commands of the ground, then faults, then the goal, then hazards.
constexpr std::array kTransitions = {
    Transition{kAllButSafe, {F::kCommandEmergencyStop}, {}, kSafe, "emergency_stop", F::kCommandEmergencyStop},
    Transition{{kSafe}, {F::kCommandClearSafe}, {}, kStandby, "clear_safe", F::kCommandClearSafe},
    Transition{{kDriving, kHazardStop, kRepairing, kPaused, kFaultStop, kGoalReached},
               {F::kCommandStop},
               {},
               kStandby,
               "stop",
               F::kCommandStop},
    Transition{
        {kDriving, kHazardStop, kRepairing, kFaultStop}, {F::kCommandPause}, {}, kPaused, "pause", F::kCommandPause},
    Transition{{kPaused},
               {F::kCommandResume, F::kPathPresent, F::kPoseFresh},
               {F::kBlockingFault},
               kDriving,
               "resume",
               F::kCommandResume},
    Transition{{kStandby},
               {F::kCommandGo, F::kPathPresent, F::kPoseFresh},
               {F::kBlockingFault},
               kDriving,
               "go",
               F::kCommandGo},
    Transition{{kBoot}, {F::kInputsReady}, {}, kStandby, "inputs_ready", F::kInputsReady},
    Transition{kUnderWay, {F::kBlockingFault}, {}, kFaultStop, "fault", F::kBlockingFault},
    Transition{kUnderWay, {F::kGoalReached}, {F::kBlockingFault}, State::kGoalReached, "goal_reached", F::kGoalReached},
    Transition{{kDriving}, {F::kPathBlocked}, {F::kBlockingFault}, kHazardStop, "path_blocked", F::kPathBlocked},
    Transition{{kHazardStop, kRepairing},
               {F::kPathClear},
               {F::kBlockingFault, F::kPathBlocked},
               kDriving,
               "path_clear",
               F::kPathClear},
    Transition{{kHazardStop},
               {F::kStanding, F::kPlannerRepairing},
               {F::kBlockingFault},
               kRepairing,
               "planner_repairing",
               F::kPlannerRepairing},
    Transition{{kFaultStop}, {F::kPathBlocked}, {F::kBlockingFault}, kHazardStop, "faults_cleared", F::kBlockingFault},
    Transition{{kFaultStop}, {}, {F::kBlockingFault, F::kPathBlocked}, kDriving, "faults_cleared", F::kBlockingFault},
};

constexpr std::array kPermitRules = {
    PermitRule{kDriving, {F::kPoseFresh, F::kPathPresent}, {F::kBlockingFault, F::kPathBlocked, F::kGoalReached}},
};

constexpr std::array<const char*, kStateCount> kStateNames = {"BOOT",         "STANDBY",    "DRIVING",    "HAZARD_STOP",
                                                              "REPAIRING",    "SWEEPING",   "CORRECTING", "PAUSED",
                                                              "GOAL_REACHED", "FAULT_STOP", "SAFE",       "TELEOP"};
constexpr std::array<const char*, kFactCount> kFactNames = {
    "inputs_ready", "pose_fresh", "path_present", "blocking_fault", "path_blocked",
    "path_clear",   "standing",   "repairing",    "goal_reached",   "GO",
    "STOP",         "PAUSE",      "RESUME",       "EMERGENCY_STOP", "CLEAR_SAFE"};

std::string names(FactSet facts, const char* prefix) {
  std::string out;
  for (int i = 0; i < kFactCount; ++i)
    if (facts.has(static_cast<Fact>(i))) out += (out.empty() ? "" : ", ") + std::string(prefix) + kFactNames[i];
  return out;
}

bool fits(const Transition& row, State state, FactSet facts) {
  return row.from.has(state) && facts.has_all(row.needs) && !facts.has_any(row.bars);
}

}  // namespace

std::span<const Transition> transitions() {
  return kTransitions;
}
std::span<const PermitRule> permit_rules() {
  return kPermitRules;
}
const char* name(State state) {
  return kStateNames[static_cast<size_t>(state)];
}
const char* name(Fact fact) {
  return kFactNames[static_cast<size_t>(fact)];
}

const Transition* next_transition(State state, FactSet facts) {
  const auto row = std::find_if(kTransitions.begin(), kTransitions.end(),
                                [&](const Transition& t) { return fits(t, state, facts); });
  return row == kTransitions.end() ? nullptr : &*row;
}

bool permit_allowed(State state, FactSet facts) {
  return std::any_of(kPermitRules.begin(), kPermitRules.end(), [&](const PermitRule& rule) {
    return rule.state == state && facts.has_all(rule.needs) && !facts.has_any(rule.bars);
  });
}

std::string refusal(State state, FactSet facts, Fact command) {
  for (const Transition& row : kTransitions) {
    if (!row.from.has(state) || !row.needs.has(command)) continue;
    FactSet missing = row.needs.without(facts);
    missing.erase(command);
    const std::string lacks = names(missing, "no ");
    const std::string stands = names(row.bars.common(facts), "");
    return lacks + (lacks.empty() || stands.empty() ? "" : ", ") + stands;
  }
  return std::string("not possible in ") + name(state);
}

std::string drawing() {
  std::ostringstream out;
  out << "digraph supervisor {\n  rankdir=LR;\n  node [shape=box, style=rounded];\n";
  for (const Transition& row : kTransitions)
    for (int s = 0; s < kStateCount; ++s) {
      if (!row.from.has(static_cast<State>(s))) continue;
      const std::string needs = names(row.needs, "");
      const std::string bars = names(row.bars, "not ");
      out << "  " << kStateNames[s] << " -> " << name(row.to) << " [label=\"" << row.cause << "\\n"
          << needs << (needs.empty() || bars.empty() ? "" : ", ") << bars << "\"];\n";
    }
  out << "}\n";
  return out.str();
}

}  // namespace rover::supervisor
