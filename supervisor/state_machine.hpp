// The supervisor's machine as data: one table of transitions over facts, run by generic code.
//
// A fact is true or false at a tick: a condition measured (path clear), a state of the monitors (blocking fault), or a
// ground command just received. The first row of a table that fits decides. So every combination of state, level and
// facts can be tested, and the drawing is made from the tables. The level is a machine of its own beside the states:
// what it changes for them is one fact, kLevelFull.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

namespace rover::supervisor {

// Values as in lcmtypes/supervisor_state_t.lcm.
enum class State : std::int8_t {
  kBoot = 0,
  kStandby = 1,
  kDriving = 2,
  kHazardStop = 3,
  kRepairing = 4,
  kSweeping = 5,
  kCorrecting = 6,
  kPaused = 7,
  kGoalReached = 8,
  kFaultStop = 9,
  kSafe = 10,
  kTeleop = 11,
};
inline constexpr int kStateCount = 12;

enum class Level : std::int8_t { kEfficient = 0, kFull = 1 };

enum class Fact : int {
  kInputsReady,  // every required service and stream is there, pose known
  kPoseFresh,
  kPathPresent,
  kBlockingFault,  // at least one stands whose response is to stop
  kSafeFault,      // at least one stands whose response is to stop for good
  kPathBlocked,    // within the stopping distance, or no path to judge
  kPathClear,      // beyond the stopping distance and its hysteresis
  kStanding,
  kPlannerRepairing,
  kGoalReached,
  kLevelFull,
  kTerrainKnown,      // the Full level's map of the ground ahead is there, fresh and not empty
  kCorrectionWanted,  // global localization asks to stand still
  kTeleopFresh,       // the operator's newest motion command is young enough to be driven
  kCommandGo,
  kCommandStop,
  kCommandPause,
  kCommandResume,
  kCommandEmergencyStop,
  kCommandClearSafe,
  kCommandTeleop,
};
inline constexpr int kFactCount = 21;

// What the level is chosen from.
enum class LevelFact : int {
  kFullReady,   // the services of the Full level live
  kForcedFull,  // by ground command
  kForcedEfficient,
  kPathFull,      // the path's segment asks for Full
  kRaisedByPath,  // the level was raised because of the path, not on board
  kSlowProgress,  // effective speed below its limit, over a whole window
  kManyHazards,   // per way, over a whole window
  kEasyAhead,     // difficulty of the ground ahead below its limit, for the whole of a way
  kFullFailing,   // one of the Full level's services dies over and over, or a sweep is in vain
};
inline constexpr int kLevelFactCount = 9;

// A small set of enumerators.
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
  constexpr EnumSet common(EnumSet other) const { return from_bits(bits_ & other.bits_); }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr std::uint32_t bits() const { return bits_; }

 private:
  static constexpr std::uint32_t bit(Enum e) { return std::uint32_t{1} << static_cast<std::uint32_t>(e); }
  std::uint32_t bits_ = 0;
};
using FactSet = EnumSet<Fact>;
using LevelFactSet = EnumSet<LevelFact>;
using StateSet = EnumSet<State>;

// On the way to the goal, or standing on it for a moment; and with the stop of a fault that may clear.
inline constexpr StateSet kUnderWay = {State::kDriving, State::kHazardStop, State::kRepairing, State::kSweeping,
                                       State::kCorrecting};
inline constexpr StateSet kUnderWayOrFaultStop = {State::kDriving,  State::kHazardStop, State::kRepairing,
                                                  State::kSweeping, State::kCorrecting, State::kFaultStop};

// From any of the states, where all of `needs` and none of `bars` hold.
struct Transition {
  StateSet from;
  FactSet needs;
  FactSet bars;
  State to;
  const char* cause;
  Fact evidence;  // whose measured quantity the change is published with
};

struct LevelTransition {
  Level from;
  LevelFactSet needs;
  LevelFactSet bars;
  Level to;
  const char* cause;
  LevelFact evidence;
};

// A permit is granted in this state alone, where all of `needs` and none of `bars` hold.
struct PermitRule {
  State state;
  FactSet needs;
  FactSet bars;
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

// The row that fires, or null.
const Transition* next_transition(State state, FactSet facts);
const LevelTransition* next_level(Level level, LevelFactSet facts);
bool permit_allowed(State state, FactSet facts);
// Why the command does nothing in this state, for its refusal.
std::string refusal(State state, FactSet facts, Fact command);
// The machine as a Graphviz drawing.
std::string drawing();

}  // namespace rover::supervisor
