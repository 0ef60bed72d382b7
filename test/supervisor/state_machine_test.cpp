// The machine's table, walked through every state with every set of facts.
#include "supervisor/state_machine.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace rover::supervisor {
namespace {

using enum State;
using F = Fact;

constexpr std::uint32_t kFactSets = 1U << kFactCount;

State state(int s) {
  return static_cast<State>(s);
}

// Of a clear path and a blocked one at most one holds, and without a path it is blocked: so the facts are made.
bool possible(FactSet facts) {
  const bool blocked = facts.has(F::kPathBlocked);
  return !(blocked && facts.has(F::kPathClear)) && (facts.has(F::kPathPresent) || blocked);
}

template <class Visit>
void for_all(Visit visit) {
  for (int s = 0; s < kStateCount; ++s)
    for (std::uint32_t bits = 0; bits < kFactSets; ++bits) {
      const FactSet facts = FactSet::from_bits(bits);
      if (possible(facts)) visit(state(s), facts);
    }
}

// As the supervisor runs it: commands last for one transition.
State settle(State s, FactSet facts, int& steps) {
  for (steps = 0; steps <= kStateCount; ++steps) {
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
      for (int s = 0; s < kStateCount; ++s)
        if (row.from.has(state(s)) && out.count(state(s)) > 0) out.insert(row.to);
  }
  return out;
}

TEST(StateMachine, SettlesUnderEveryFact) {
  int longest = 0;
  for_all([&](State s, FactSet facts) {
    int steps = 0;
    settle(s, facts, steps);
    longest = std::max(longest, steps);
  });
  EXPECT_LE(longest, 4);
}

TEST(StateMachine, NoPermitOutsideOfDrivingOrWithAnythingAgainstIt) {
  int granted = 0;
  for_all([&](State s, FactSet facts) {
    int steps = 0;
    const State settled = settle(s, facts, steps);
    if (!permit_allowed(settled, facts)) return;
    ++granted;
    ASSERT_EQ(settled, kDriving);
    ASSERT_FALSE(facts.has(F::kBlockingFault));
    ASSERT_TRUE(facts.has(F::kPoseFresh));
    ASSERT_TRUE(facts.has(F::kPathPresent));
    ASSERT_FALSE(facts.has(F::kPathBlocked));
  });
  EXPECT_GT(granted, 0);
}

TEST(StateMachine, ABlockingFaultEndsDrivingInTheSameTick) {
  for_all([&](State s, FactSet facts) {
    if (!facts.has(F::kBlockingFault)) return;
    int steps = 0;
    const State settled = settle(s, facts, steps);
    ASSERT_NE(settled, kDriving);
    ASSERT_NE(settled, kHazardStop);
    ASSERT_NE(settled, kRepairing);
  });
}

TEST(StateMachine, SafeIsLeftByGroundCommandAlone) {
  for_all([&](State s, FactSet facts) {
    if (s != kSafe) return;
    int steps = 0;
    if (!facts.has(F::kCommandClearSafe)) {
      ASSERT_EQ(settle(s, facts, steps), kSafe);
    }
  });
}

TEST(StateMachine, AnEmergencyStopLeadsToSafeFromEverywhere) {
  for_all([&](State s, FactSet facts) {
    if (s == kSafe || !facts.has(F::kCommandEmergencyStop)) return;
    const Transition* row = next_transition(s, facts);
    ASSERT_NE(row, nullptr);
    ASSERT_EQ(row->to, kSafe);
  });
}

TEST(StateMachine, DrivingBeginsByGroundCommandOrAfterADriveThatItBegan) {
  for (const Transition& row : transitions()) {
    if (row.to != kDriving) continue;
    const bool commanded = row.needs.has_any(kCommandFacts);
    const bool resumed = StateSet{kHazardStop, kRepairing, kFaultStop}.has_all(row.from);
    EXPECT_TRUE(commanded || resumed) << row.cause;
  }
  // And into those three nothing leads but from a drive.
  for (const Transition& row : transitions())
    if (StateSet{kHazardStop, kRepairing, kFaultStop}.has(row.to)) {
      EXPECT_TRUE((StateSet{kDriving, kHazardStop, kRepairing, kFaultStop}.has_all(row.from))) << row.cause;
    }
}

TEST(StateMachine, EveryReachableStateHasAWayOutAndBackToDriving) {
  for (const State s : reachable()) {
    bool leaves = false;
    for (const Transition& row : transitions()) leaves |= row.from.has(s) && row.to != s;
    EXPECT_TRUE(leaves) << name(s);
    std::set<State> from_here = {s};
    for (size_t before = 0; before != from_here.size();) {
      before = from_here.size();
      for (const Transition& row : transitions())
        for (int k = 0; k < kStateCount; ++k)
          if (row.from.has(state(k)) && from_here.count(state(k)) > 0) from_here.insert(row.to);
    }
    EXPECT_EQ(from_here.count(kDriving), 1u) << name(s);
  }
}

TEST(StateMachine, EveryRowFiresUnderSomeFacts) {
  std::set<const Transition*> fired;
  for_all([&](State s, FactSet facts) {
    if (const Transition* row = next_transition(s, facts)) fired.insert(row);
  });
  EXPECT_EQ(fired.size(), transitions().size());
}

TEST(StateMachine, ReachesTheStatesOfTheFirstVersion) {
  EXPECT_EQ(reachable(), (std::set<State>{kBoot, kStandby, kDriving, kHazardStop, kRepairing, kPaused, kGoalReached,
                                          kFaultStop, kSafe}));
}

TEST(StateMachine, FollowsASmallReferenceOfItsRules) {
  for_all([&](State s, FactSet facts) {
    if (facts.has_any(kCommandFacts)) return;
    int steps = 0;
    const State settled = settle(s, facts, steps);
    const bool under_way = s == kDriving || s == kHazardStop || s == kRepairing;
    if (under_way && facts.has(F::kBlockingFault)) {
      ASSERT_EQ(settled, kFaultStop);
    } else if (under_way && facts.has(F::kGoalReached)) {
      ASSERT_EQ(settled, kGoalReached);
    } else if (under_way && facts.has(F::kPathBlocked)) {
      ASSERT_TRUE(settled == kHazardStop || settled == kRepairing);
    } else if (under_way && facts.has(F::kPathClear)) {
      ASSERT_EQ(settled, kDriving);
    } else if (s == kPaused || s == kGoalReached || s == kStandby || s == kSafe) {
      ASSERT_EQ(settled, s);
    }
  });
}

TEST(StateMachine, RefusalsNameTheReason) {
  EXPECT_EQ(refusal(kDriving, {}, F::kCommandGo), "not possible in DRIVING");
  EXPECT_EQ(refusal(kStandby, {F::kPoseFresh}, F::kCommandGo), "no path_present");
  EXPECT_EQ(refusal(kStandby, {F::kPoseFresh, F::kPathPresent, F::kBlockingFault}, F::kCommandGo), "blocking_fault");
}

TEST(StateMachine, TheCommittedDrawingIsTheTables) {
  std::ifstream file(ROVER_SOURCE_DIR "/supervisor/state_machine.dot");
  ASSERT_TRUE(file.good());
  std::stringstream committed;
  committed << file.rdbuf();
  EXPECT_EQ(committed.str(), drawing());
}

}  // namespace
}  // namespace rover::supervisor
