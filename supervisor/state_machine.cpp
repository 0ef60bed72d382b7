#include "supervisor/state_machine.hpp"

#include <algorithm>
#include <sstream>

namespace rover::supervisor {
namespace {

using enum State;
using F = Fact;

constexpr StateSet kAllButSafe = {kBoot,     kStandby, kDriving,     kHazardStop, kRepairing,
                                  kSweeping, kPaused,  kGoalReached, kFaultStop,  kTeleop};

// First match wins. Order of priority: SAFE, ground commands, faults, goal, sweeping, hazards.
constexpr std::array kTransitions = {
    Transition{kAllButSafe, {F::kCommandEmergencyStop}, {}, kSafe, "emergency_stop", F::kCommandEmergencyStop},
    Transition{kAllButSafe, {F::kSafeFault}, {}, kSafe, "safe_fault", F::kSafeFault},
    Transition{{kSafe}, {F::kCommandClearSafe}, {F::kSafeFault}, kStandby, "clear_safe", F::kCommandClearSafe},
    Transition{{kDriving, kHazardStop, kRepairing, kSweeping, kPaused, kFaultStop, kGoalReached, kTeleop},
               {F::kCommandStop},
               {},
               kStandby,
               "stop",
               F::kCommandStop},
    Transition{{kDriving, kHazardStop, kRepairing, kSweeping, kFaultStop},
               {F::kCommandPause},
               {},
               kPaused,
               "pause",
               F::kCommandPause},
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
    Transition{{kStandby, kPaused},
               {F::kCommandTeleop, F::kPoseFresh},
               {F::kBlockingFault},
               kTeleop,
               "teleop",
               F::kCommandTeleop},
    Transition{{kBoot}, {F::kInputsReady}, {}, kStandby, "inputs_ready", F::kInputsReady},
    Transition{{kTeleop}, {F::kBlockingFault}, {}, kStandby, "fault", F::kBlockingFault},
    Transition{kUnderWay, {F::kBlockingFault}, {}, kFaultStop, "fault", F::kBlockingFault},
    Transition{kUnderWay, {F::kGoalReached}, {F::kBlockingFault}, State::kGoalReached, "goal_reached", F::kGoalReached},
    Transition{{kDriving, kHazardStop, kRepairing},
               {F::kLevelFull},
               {F::kTerrainKnown, F::kBlockingFault},
               kSweeping,
               "terrain_unknown",
               F::kTerrainKnown},
    Transition{{kSweeping}, {F::kTerrainKnown}, {F::kBlockingFault}, kDriving, "terrain_known", F::kTerrainKnown},
    Transition{{kSweeping}, {}, {F::kLevelFull, F::kBlockingFault}, kDriving, "level_efficient", F::kLevelFull},
    Transition{{kDriving}, {F::kPathBlocked}, {F::kBlockingFault}, kHazardStop, "path_blocked", F::kPathBlocked},
    Transition{{kHazardStop, kRepairing},
               {F::kPathClear},
               {F::kBlockingFault, F::kPathBlocked},
               kDriving,
               "path_clear",
               F::kPathClear},
    Transition{{kHazardStop},
               {F::kStationary, F::kPlannerRepairing},
               {F::kBlockingFault},
               kRepairing,
               "planner_repairing",
               F::kPlannerRepairing},
    Transition{{kFaultStop}, {F::kPathBlocked}, {F::kBlockingFault}, kHazardStop, "faults_cleared", F::kBlockingFault},
    Transition{{kFaultStop}, {}, {F::kBlockingFault, F::kPathBlocked}, kDriving, "faults_cleared", F::kBlockingFault},
};

constexpr std::array kPermitRules = {
    PermitRule{kDriving,
               {F::kPoseFresh, F::kPathPresent},
               {F::kBlockingFault, F::kSafeFault, F::kPathBlocked, F::kGoalReached}},
    PermitRule{kTeleop, {F::kPoseFresh, F::kTeleopFresh}, {F::kBlockingFault, F::kSafeFault}},
};

using L = LevelFact;

// Priority: ground command, path segment, on-board measures; each change resets the windows (hysteresis). The end of a
// segment lowers only a level that a segment raised; failing services only if neither path nor LocCam requires Full.
constexpr std::array kLevelTransitions = {
    LevelTransition{Level::kEfficient, {L::kForcedFull, L::kFullReady}, {}, Level::kFull, "forced", L::kForcedFull},
    LevelTransition{Level::kFull, {L::kForcedEfficient}, {}, Level::kEfficient, "forced", L::kForcedEfficient},
    LevelTransition{Level::kEfficient,
                    {L::kPathFull, L::kFullReady},
                    {L::kForcedEfficient},
                    Level::kFull,
                    "path_segment",
                    L::kPathFull},
    LevelTransition{Level::kEfficient,
                    {L::kSlowProgress, L::kFullReady},
                    {L::kForcedEfficient, L::kFullFailing},
                    Level::kFull,
                    "slow_progress",
                    L::kSlowProgress},
    LevelTransition{Level::kEfficient,
                    {L::kManyHazards, L::kFullReady},
                    {L::kForcedEfficient, L::kFullFailing},
                    Level::kFull,
                    "many_hazards",
                    L::kManyHazards},
    LevelTransition{Level::kEfficient,
                    {L::kNoPath, L::kFullReady},
                    {L::kForcedEfficient, L::kFullFailing},
                    Level::kFull,
                    "no_path",
                    L::kNoPath},
    LevelTransition{Level::kEfficient,
                    {L::kLocCamOut, L::kFullReady},
                    {L::kForcedEfficient, L::kFullFailing},
                    Level::kFull,
                    "loccam_out",
                    L::kLocCamOut},
    LevelTransition{Level::kFull,
                    {L::kRaisedByPath},
                    {L::kPathFull, L::kForcedFull, L::kNoPath, L::kLocCamOut},
                    Level::kEfficient,
                    "path_segment",
                    L::kPathFull},
    LevelTransition{Level::kFull,
                    {L::kEasyAhead},
                    {L::kPathFull, L::kForcedFull, L::kNoPath, L::kLocCamOut},
                    Level::kEfficient,
                    "easy_terrain",
                    L::kEasyAhead},
    LevelTransition{Level::kFull,
                    {L::kFullFailing},
                    {L::kPathFull, L::kForcedFull, L::kLocCamOut},
                    Level::kEfficient,
                    "full_failing",
                    L::kFullFailing},
};

constexpr std::array<const char*, kFactCount> kFactNames = {
    "inputs_ready", "pose_fresh", "path_present", "blocking_fault", "safe_fault",    "path_blocked", "path_clear",
    "stationary",   "repairing",  "goal_reached", "level_full",     "terrain_known", "teleop_fresh", "GO",
    "STOP",         "PAUSE",      "RESUME",       "EMERGENCY_STOP", "CLEAR_SAFE",    "TELEOP"};
constexpr std::array<const char*, 2> kLevelNames = {"EFFICIENT", "FULL"};
constexpr std::array<const char*, kLevelFactCount> kLevelFactNames = {
    "full_ready",   "forced_full", "forced_efficient", "path_full",    "raised_by_path", "slow_progress",
    "many_hazards", "no_path",     "easy_ahead",       "full_failing", "loccam_out"};

template <class Enum, size_t N>
std::string names(EnumSet<Enum> facts, const std::array<const char*, N>& of, const char* prefix) {
  std::string out;
  for (size_t i = 0; i < N; ++i)
    if (facts.has(static_cast<Enum>(i))) out += (out.empty() ? "" : ", ") + std::string(prefix) + of[i];
  return out;
}

std::string names(FactSet facts, const char* prefix) {
  return names(facts, kFactNames, prefix);
}

// Guard text of an edge.
template <class Set, size_t N>
std::string condition(Set required, Set forbidden, const std::array<const char*, N>& of) {
  const std::string required_text = names(required, of, "");
  const std::string forbidden_text = names(forbidden, of, "not ");
  return required_text + (required_text.empty() || forbidden_text.empty() ? "" : ", ") + forbidden_text;
}

bool matches(const Transition& row, State state, FactSet facts) {
  return row.from.has(state) && facts.has_all(row.required) && !facts.has_any(row.forbidden);
}

}  // namespace

std::span<const Transition> transitions() {
  return kTransitions;
}
std::span<const LevelTransition> level_transitions() {
  return kLevelTransitions;
}
std::span<const PermitRule> permit_rules() {
  return kPermitRules;
}
const char* name(State state) {
  switch (state) {
    case kBoot:
      return "BOOT";
    case kStandby:
      return "STANDBY";
    case kDriving:
      return "DRIVING";
    case kHazardStop:
      return "HAZARD_STOP";
    case kRepairing:
      return "REPAIRING";
    case kSweeping:
      return "SWEEPING";
    case kPaused:
      return "PAUSED";
    case State::kGoalReached:
      return "GOAL_REACHED";
    case kFaultStop:
      return "FAULT_STOP";
    case kSafe:
      return "SAFE";
    case kTeleop:
      return "TELEOP";
  }
  return "?";
}
const char* name(Fact fact) {
  return kFactNames[static_cast<size_t>(fact)];
}
const char* name(Level level) {
  return kLevelNames[static_cast<size_t>(level)];
}

const Transition* next_transition(State state, FactSet facts) {
  const auto row = std::find_if(kTransitions.begin(), kTransitions.end(),
                                [&](const Transition& t) { return matches(t, state, facts); });
  return row == kTransitions.end() ? nullptr : &*row;
}

const LevelTransition* next_level(Level level, LevelFactSet facts) {
  const auto row = std::find_if(kLevelTransitions.begin(), kLevelTransitions.end(), [&](const LevelTransition& t) {
    return t.from == level && facts.has_all(t.required) && !facts.has_any(t.forbidden);
  });
  return row == kLevelTransitions.end() ? nullptr : &*row;
}

bool permit_allowed(State state, FactSet facts) {
  return std::any_of(kPermitRules.begin(), kPermitRules.end(), [&](const PermitRule& rule) {
    return rule.state == state && facts.has_all(rule.required) && !facts.has_any(rule.forbidden);
  });
}

std::string refusal_reason(State state, FactSet facts, Fact command) {
  for (const Transition& row : kTransitions) {
    if (!row.from.has(state) || !row.required.has(command)) continue;
    FactSet missing = row.required.without(facts);
    missing.erase(command);
    const std::string missing_text = names(missing, "no ");
    const std::string blocking_text = names(row.forbidden.intersection(facts), "");
    return missing_text + (missing_text.empty() || blocking_text.empty() ? "" : ", ") + blocking_text;
  }
  return std::string("not possible in ") + name(state);
}

std::string to_graphviz() {
  std::ostringstream out;
  out << "digraph supervisor {\n  rankdir=LR;\n  node [shape=box, style=rounded];\n";
  for (const Transition& row : kTransitions)
    for (const State from : kStates) {
      if (!row.from.has(from)) continue;
      out << "  " << name(from) << " -> " << name(row.to) << " [label=\"" << row.cause << "\\n"
          << condition(row.required, row.forbidden, kFactNames) << "\"];\n";
    }
  out << "  subgraph cluster_level {\n    label=\"level\";\n";
  for (const LevelTransition& row : kLevelTransitions)
    out << "    " << name(row.from) << " -> " << name(row.to) << " [label=\"" << row.cause << "\\n"
        << condition(row.required, row.forbidden, kLevelFactNames) << "\"];\n";
  out << "  }\n}\n";
  return out.str();
}

}  // namespace rover::supervisor
