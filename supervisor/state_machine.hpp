// The supervisor's machine as data: one table of transitions over facts, run by generic code.
//
// A fact is true or false at a tick: a condition measured (path clear), a state of the monitors (blocking fault), or a
// ground command just received. The first row of the table that fits decides. So every combination of state and facts
// can be tested, and the drawing is made from the table.
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

enum class Fact : int {
  kInputsReady,  // every required service and stream is there, pose known
  kPoseFresh,
  kPathPresent,
  kBlockingFault,  // at least one stands whose response is to stop
  kPathBlocked,    // within the stopping distance, or no path to judge
  kPathClear,      // beyond the stopping distance and its hysteresis
  kStanding,
  kPlannerRepairing,
  kGoalReached,
  kCommandGo,
  kCommandStop,
  kCommandPause,
  kCommandResume,
  kCommandEmergencyStop,
  kCommandClearSafe,
};
inline constexpr int kFactCount = 15;

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

 private:
  static constexpr std::uint32_t bit(Enum e) { return std::uint32_t{1} << static_cast<std::uint32_t>(e); }
  std::uint32_t bits_ = 0;
};
using FactSet = EnumSet<Fact>;
using StateSet = EnumSet<State>;

// From any of the states, where all of `needs` and none of `bars` hold.
struct Transition {
  StateSet from;
  FactSet needs;
  FactSet bars;
  State to;
  const char* cause;
  Fact evidence;  // whose measured quantity the change is published with
};

// A permit is granted in this state alone, where all of `needs` and none of `bars` hold.
struct PermitRule {
  State state;
  FactSet needs;
  FactSet bars;
};

std::span<const Transition> transitions();
std::span<const PermitRule> permit_rules();
const char* name(State state);
const char* name(Fact fact);
inline constexpr FactSet kCommandFacts = {Fact::kCommandGo,     Fact::kCommandStop,          Fact::kCommandPause,
                                          Fact::kCommandResume, Fact::kCommandEmergencyStop, Fact::kCommandClearSafe};

// The row that fires, or null.
const Transition* next_transition(State state, FactSet facts);
bool permit_allowed(State state, FactSet facts);
// Why the command does nothing in this state, for its refusal.
std::string refusal(State state, FactSet facts, Fact command);
// The machine as a Graphviz drawing.
std::string drawing();

}  // namespace rover::supervisor
