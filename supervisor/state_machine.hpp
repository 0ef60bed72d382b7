// Table-driven state machine. Guards are facts: boolean conditions at a tick (measured, fault active, command
// received). The first matching row of the table fires, so all combinations of state and facts are tested, and the
// Graphviz drawing is generated. The autonomy level is a second machine; the states see it only as the fact kLevelFull.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

namespace rover::supervisor {

// Values as in lcmtypes/supervisor_state_t.lcm, where 6 is not used.
enum class State : std::int8_t {
  kBoot = 0,
  kStandby = 1,
  kDriving = 2,
  kHazardStop = 3,
  kRepairing = 4,
  kSweeping = 5,
  kPaused = 7,
  kGoalReached = 8,
  kFaultStop = 9,
  kSafe = 10,
  kTeleop = 11,
};
inline constexpr std::array kStates = {State::kBoot,      State::kStandby,  State::kDriving, State::kHazardStop,
                                       State::kRepairing, State::kSweeping, State::kPaused,  State::kGoalReached,
                                       State::kFaultStop, State::kSafe,     State::kTeleop};

enum class Level : std::int8_t { kEfficient = 0, kFull = 1 };

enum class Fact : int {
  kInputsReady,  // all required services and streams alive, pose valid
  kPoseFresh,
  kPathPresent,
  kBlockingFault,  // an active fault stops the rover
  kSafeFault,      // an active fault leads to SAFE
  kPathBlocked,    // blocked within the stopping distance, or no path
  kPathClear,      // free beyond the stopping distance plus hysteresis
  kStationary,
  kPlannerRepairing,
  kGoalReached,
  kLevelFull,
  kTerrainKnown,  // the Full-level map is recent and covers the ground ahead
  kTeleopFresh,   // the newest operator command is recent
  kCommandGo,
  kCommandStop,
  kCommandPause,
  kCommandResume,
  kCommandEmergencyStop,
  kCommandClearSafe,
  kCommandTeleop,
};
inline constexpr int kFactCount = 20;

// Facts of the level machine.
enum class LevelFact : int {
  kFullReady,   // all services of the Full level are alive
  kForcedFull,  // by ground command
  kForcedEfficient,
  kPathFull,      // the current path segment requires Full
  kRaisedByPath,  // the level was raised by the path, not on board
  kSlowProgress,  // effective speed below its limit over a full window
  kManyHazards,   // hazards per metre above its limit in the window
  kNoPath,        // the planner found none with what this level sees
  kEasyAhead,     // terrain difficulty below its limit over easy_distance_m
  kFullFailing,   // a Full-level service restarts repeatedly, or a sweep fails
  kLocCamOut,     // a fault stops the rover at Efficient that does not at Full
};
inline constexpr int kLevelFactCount = 11;

// Bit set of enumerators.
template <class Enum>
class EnumSet {
 public:
  constexpr EnumSet() = default;
  constexpr EnumSet(std::initializer_list<Enum> members) {
    for (const Enum e : members) insert(e);
  }
  static constexpr EnumSet from_bits(std::uint32_t bits) {
    EnumSet out;
    out.bits_ = bits;
    return out;
  }
  constexpr void insert(Enum e) { bits_ |= bit(e); }
  constexpr void erase(Enum e) { bits_ &= ~bit(e); }
  constexpr void set(Enum e, bool on) { on ? insert(e) : erase(e); }
  constexpr bool has(Enum e) const { return (bits_ & bit(e)) != 0; }
  constexpr bool has_all(EnumSet other) const { return (bits_ & other.bits_) == other.bits_; }
  constexpr bool has_any(EnumSet other) const { return (bits_ & other.bits_) != 0; }
  constexpr EnumSet without(EnumSet other) const { return from_bits(bits_ & ~other.bits_); }
  constexpr EnumSet intersection(EnumSet other) const { return from_bits(bits_ & other.bits_); }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr std::uint32_t bits() const { return bits_; }

 private:
  static constexpr std::uint32_t bit(Enum e) { return std::uint32_t{1} << static_cast<std::uint32_t>(e); }
  std::uint32_t bits_ = 0;
};
using FactSet = EnumSet<Fact>;
using LevelFactSet = EnumSet<LevelFact>;
using StateSet = EnumSet<State>;

// States of a drive in progress; the second set includes stops by faults that may clear.
inline constexpr StateSet kUnderWay = {State::kDriving, State::kHazardStop, State::kRepairing, State::kSweeping};
inline constexpr StateSet kUnderWayOrFaultStop = {State::kDriving, State::kHazardStop, State::kRepairing,
                                                  State::kSweeping, State::kFaultStop};

// Fires in any `from` state if all `required` and no `forbidden` facts are true.
struct Transition {
  StateSet from;
  FactSet required;
  FactSet forbidden;
  State to;
  const char* cause;
  Fact evidence;  // fact whose measured value is published with the change
};

struct LevelTransition {
  Level from;
  LevelFactSet required;
  LevelFactSet forbidden;
  Level to;
  const char* cause;
  LevelFact evidence;
};

// Permits are granted only by these rules.
struct PermitRule {
  State state;
  FactSet required;
  FactSet forbidden;
};

std::span<const Transition> transitions();
std::span<const LevelTransition> level_transitions();
std::span<const PermitRule> permit_rules();
const char* name(State state);
const char* name(Fact fact);
const char* name(Level level);
inline constexpr FactSet kCommandFacts = {Fact::kCommandGo,     Fact::kCommandStop,          Fact::kCommandPause,
                                          Fact::kCommandResume, Fact::kCommandEmergencyStop, Fact::kCommandClearSafe,
                                          Fact::kCommandTeleop};

// First matching row, or null.
const Transition* next_transition(State state, FactSet facts);
const LevelTransition* next_level(Level level, LevelFactSet facts);
bool permit_allowed(State state, FactSet facts);
// Reason why the command is refused in this state.
std::string refusal_reason(State state, FactSet facts, Fact command);
// Both machines in Graphviz format.
std::string to_graphviz();

}  // namespace rover::supervisor
