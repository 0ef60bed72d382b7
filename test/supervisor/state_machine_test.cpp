// Exhaustive tests of the transition tables: every state with every set of facts.
#include "supervisor/state_machine.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <set>
#include <sstream>

namespace rover::supervisor {
namespace {

using enum State;
using F = Fact;

constexpr std::uint32_t kFactSets = 1U << kFactCount;

// States of a drive that waits.
constexpr StateSet kWaiting = {kHazardStop, kRepairing, kSweeping, kFaultStop};

// Constraints between facts: a path is not both clear and blocked, no path means blocked, one command at a time, and a
// safe fault is also a blocking fault.
bool is_consistent(FactSet facts) {
  const bool blocked = facts.has(F::kPathBlocked);
  const bool one_command = std::popcount(facts.intersection(kCommandFacts).bits()) <= 1;
  return !(blocked && facts.has(F::kPathClear)) && (facts.has(F::kPathPresent) || blocked) && one_command &&
         (facts.has(F::kBlockingFault) || !facts.has(F::kSafeFault));
}

template <class Visit>
void for_all(Visit visit) {
  for (const State s : kStates)
    for (std::uint32_t bits = 0; bits < kFactSets; ++bits) {
      const FactSet facts = FactSet::from_bits(bits);
      if (is_consistent(facts)) visit(s, facts);
    }
}

// As in the supervisor: a command is valid for one transition.
State settle(State s, FactSet facts, int& steps) {
  for (steps = 0; steps <= static_cast<int>(kStates.size()); ++steps) {
    const Transition* row = next_transition(s, facts);
    if (row == nullptr) return s;
    s = row->to;
    facts = facts.without(kCommandFacts);
  }
  return s;
}

std::set<State> reachable() {
  std::set<State> out = {kBoot};
  for (size_t before = 0; before != out.size();) {
    before = out.size();
    for (const Transition& row : transitions())
      for (const State s : kStates)
        if (row.from.has(s) && out.count(s) > 0) out.insert(row.to);
  }
  return out;
}

TEST(StateMachine, SettlesForEveryFactSet) {
  int longest = 0;
  for_all([&](State s, FactSet facts) {
    int steps = 0;
    settle(s, facts, steps);
    longest = std::max(longest, steps);
  });
  EXPECT_LE(longest, 4);
}

TEST(StateMachine, NoPermitWithAnyBlockingFact) {
  int granted = 0;
  for_all([&](State s, FactSet facts) {
    int steps = 0;
    const State settled = settle(s, facts, steps);
    if (!permit_allowed(settled, facts)) return;
    ++granted;
    ASSERT_TRUE(settled == kDriving || settled == kTeleop);
    ASSERT_FALSE(facts.has_any({F::kBlockingFault, F::kSafeFault}));
    ASSERT_TRUE(facts.has(F::kPoseFresh));
    if (settled == kTeleop) {
      ASSERT_TRUE(facts.has(F::kTeleopFresh));
    } else {
      ASSERT_TRUE(facts.has(F::kPathPresent));
      ASSERT_FALSE(facts.has(F::kPathBlocked));
      ASSERT_TRUE(facts.has(F::kTerrainKnown) || !facts.has(F::kLevelFull));
    }
  });
  EXPECT_GT(granted, 0);
}

TEST(StateMachine, BlockingFaultStopsDrivingInTheSameTick) {
  for_all([&](State s, FactSet facts) {
    if (!facts.has(F::kBlockingFault)) return;
    int steps = 0;
    const State settled = settle(s, facts, steps);
    ASSERT_FALSE((StateSet{kDriving, kHazardStop, kRepairing, kSweeping, kTeleop}.has(settled)));
  });
}

TEST(StateMachine, OnlyClearSafeLeavesSafe) {
  for_all([&](State s, FactSet facts) {
    if (s != kSafe) return;
    int steps = 0;
    if (!facts.has(F::kCommandClearSafe)) {
      ASSERT_EQ(settle(s, facts, steps), kSafe);
    }
  });
}

TEST(StateMachine, SafeFaultLeadsToSafeAndKeepsIt) {
  for_all([&](State s, FactSet facts) {
    int steps = 0;
    if (facts.has(F::kSafeFault)) {
      ASSERT_EQ(settle(s, facts, steps), kSafe);
    }
  });
}

TEST(StateMachine, EmergencyStopLeadsToSafeFromEveryState) {
  for_all([&](State s, FactSet facts) {
    if (s == kSafe || !facts.has(F::kCommandEmergencyStop)) return;
    const Transition* row = next_transition(s, facts);
    ASSERT_NE(row, nullptr);
    ASSERT_EQ(row->to, kSafe);
  });
}

TEST(StateMachine, DrivingStartsByGroundCommandOrResumesADrive) {
  for (const Transition& row : transitions()) {
    if (row.to != kDriving) continue;
    const bool commanded = row.required.has_any(kCommandFacts);
    const bool resumed = kWaiting.has_all(row.from);
    EXPECT_TRUE(commanded || resumed) << row.cause;
  }
  // The waiting states are entered only from a drive.
  for (const Transition& row : transitions())
    if (kWaiting.has(row.to)) {
      EXPECT_TRUE(row.from.without(kWaiting).without({kDriving}).empty()) << row.cause;
    }
}

TEST(StateMachine, EveryReachableStateCanBeLeftAndLeadsBackToDriving) {
  for (const State s : reachable()) {
    bool leaves = false;
    for (const Transition& row : transitions()) leaves |= row.from.has(s) && row.to != s;
    EXPECT_TRUE(leaves) << name(s);
    std::set<State> from_here = {s};
    for (size_t before = 0; before != from_here.size();) {
      before = from_here.size();
      for (const Transition& row : transitions())
        for (const State k : kStates)
          if (row.from.has(k) && from_here.count(k) > 0) from_here.insert(row.to);
    }
    EXPECT_EQ(from_here.count(kDriving), 1u) << name(s);
  }
}

TEST(StateMachine, EveryTransitionFiresForSomeFacts) {
  std::set<const Transition*> fired;
  for_all([&](State s, FactSet facts) {
    if (const Transition* row = next_transition(s, facts)) fired.insert(row);
  });
  EXPECT_EQ(fired.size(), transitions().size());
}

TEST(StateMachine, EveryStateIsReachable) {
  EXPECT_EQ(reachable().size(), kStates.size());
}

TEST(StateMachine, MatchesAReferenceImplementation) {
  for_all([&](State s, FactSet facts) {
    if (facts.has_any(kCommandFacts) || facts.has(F::kSafeFault)) return;
    int steps = 0;
    const State settled = settle(s, facts, steps);
    const bool in_drive = s == kDriving || s == kHazardStop || s == kRepairing;
    if (in_drive && facts.has(F::kBlockingFault)) {
      ASSERT_EQ(settled, kFaultStop);
    } else if (in_drive && facts.has(F::kGoalReached)) {
      ASSERT_EQ(settled, State::kGoalReached);
    } else if (in_drive && facts.has(F::kLevelFull) && !facts.has(F::kTerrainKnown)) {
      ASSERT_EQ(settled, kSweeping);
    } else if (in_drive && facts.has(F::kPathBlocked)) {
      ASSERT_TRUE(settled == kHazardStop || settled == kRepairing);
    } else if (in_drive && facts.has(F::kPathClear)) {
      ASSERT_EQ(settled, kDriving);
    } else if (s == kPaused || s == State::kGoalReached || s == kStandby || s == kSafe) {
      ASSERT_EQ(settled, s);
    }
  });
}

using L = LevelFact;

template <class Visit>
void for_all_levels(Visit visit) {
  for (const Level level : {Level::kEfficient, Level::kFull})
    for (std::uint32_t bits = 0; bits < (1U << kLevelFactCount); ++bits) {
      const LevelFactSet facts = LevelFactSet::from_bits(bits);
      const bool both = facts.has_all({L::kForcedFull, L::kForcedEfficient});
      // kRaisedByPath is only possible at the Full level.
      if (!both && (level == Level::kFull || !facts.has(L::kRaisedByPath))) visit(level, facts);
    }
}

TEST(LevelMachine, ChangesOnlyByItsRules) {
  for_all_levels([](Level level, LevelFactSet facts) {
    const LevelTransition* row = next_level(level, facts);
    const bool found_hard =
        facts.has_any({L::kSlowProgress, L::kManyHazards, L::kNoPath, L::kLocCamOut}) && !facts.has(L::kFullFailing);
    const bool up =
        facts.has(L::kForcedFull) || (!facts.has(L::kForcedEfficient) && (facts.has(L::kPathFull) || found_hard));
    const bool down =
        facts.has(L::kForcedEfficient) ||
        (!facts.has_any({L::kForcedFull, L::kPathFull, L::kLocCamOut}) &&
         (facts.has(L::kFullFailing) || (facts.has_any({L::kRaisedByPath, L::kEasyAhead}) && !facts.has(L::kNoPath))));
    const bool changes = level == Level::kEfficient ? up && facts.has(L::kFullReady) : down;
    ASSERT_EQ(row != nullptr, changes) << name(level);
    if (row != nullptr) {
      ASSERT_NE(row->to, level);
    }
  });
}

// After a change, with the windows reset, constant facts must not change the level again.
TEST(LevelMachine, DoesNotOscillateUnderConstantFacts) {
  constexpr LevelFactSet kWindowed = {L::kSlowProgress, L::kManyHazards, L::kEasyAhead};
  for_all_levels([&](Level level, LevelFactSet facts) {
    const LevelTransition* row = next_level(level, facts);
    if (row == nullptr) return;
    LevelFactSet after = facts.without(kWindowed);
    after.set(L::kRaisedByPath, row->to == Level::kFull && row->evidence == L::kPathFull);
    ASSERT_EQ(next_level(row->to, after), nullptr) << row->cause;
  });
}

TEST(LevelMachine, EveryTransitionFiresForSomeFacts) {
  std::set<const LevelTransition*> fired;
  for_all_levels([&](Level level, LevelFactSet facts) {
    if (const LevelTransition* row = next_level(level, facts)) fired.insert(row);
  });
  EXPECT_EQ(fired.size(), level_transitions().size());
}

TEST(StateMachine, RefusalsNameTheReason) {
  EXPECT_EQ(refusal_reason(kDriving, {}, F::kCommandGo), "not possible in DRIVING");
  EXPECT_EQ(refusal_reason(kStandby, {F::kPoseFresh}, F::kCommandGo), "no path_present");
  EXPECT_EQ(refusal_reason(kStandby, {F::kPoseFresh, F::kPathPresent, F::kBlockingFault}, F::kCommandGo),
            "blocking_fault");
}

TEST(StateMachine, CommittedDotFileMatchesTheTables) {
  std::ifstream file(ROVER_SOURCE_DIR "/supervisor/state_machine.dot");
  ASSERT_TRUE(file.good());
  std::stringstream committed;
  committed << file.rdbuf();
  EXPECT_EQ(committed.str(), to_graphviz());
}

}  // namespace
}  // namespace rover::supervisor
