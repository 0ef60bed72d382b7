// Walks through the table of states.
#include "path_planner/planner_state.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

namespace rover::planning {
namespace {

constexpr std::array kModes = {Mode::kIdle, Mode::kFollowing, Mode::kPlanning, Mode::kBackingUp, Mode::kNoPath};

// Every fact that the table asks for.
const std::uint16_t kAllFacts = [] {
  std::uint16_t facts = 0;
  for (const Transition& row : transitions()) facts |= row.required | row.forbidden;
  return facts;
}();

std::set<Mode> reachable_from(Mode start) {
  std::set<Mode> reached = {start};
  for (size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const Mode mode : std::set<Mode>(reached))
      for (std::uint16_t facts = 0; facts <= kAllFacts; ++facts) reached.insert(next_mode(mode, facts));
  }
  return reached;
}

TEST(PlannerState, EveryStateIsReached) {
  EXPECT_EQ(reachable_from(Mode::kIdle).size(), kModes.size());
}

TEST(PlannerState, EveryStateLeadsBackToFollowing) {
  for (const Mode mode : kModes) EXPECT_TRUE(reachable_from(mode).contains(Mode::kFollowing)) << text_of(mode);
}

TEST(PlannerState, NoTwoRowsHaveTheSameStateAndCondition) {
  std::set<std::tuple<Mode, std::uint16_t, std::uint16_t>> rows;
  for (const Transition& row : transitions())
    EXPECT_TRUE(rows.emplace(row.from, row.required, row.forbidden).second) << text_of(row.from);
}

TEST(PlannerState, EveryRowFiresForSomeFacts) {
  for (const Transition& row : transitions()) {
    const auto fires = [&](std::uint16_t facts) {
      for (const Transition& other : transitions()) {
        const bool fits =
            other.from == row.from && (facts & other.required) == other.required && (facts & other.forbidden) == 0;
        if (fits) return &other == &row;
      }
      return false;
    };
    bool fired = false;
    for (std::uint16_t facts = 0; facts <= kAllFacts; ++facts) fired = fired || fires(facts);
    EXPECT_TRUE(fired) << text_of(row.from) << " " << row.required << " " << row.forbidden;
  }
}

TEST(PlannerState, WithoutPoseOrGlobalPathItIsIdle) {
  for (const Mode mode : kModes)
    for (std::uint16_t facts = 0; facts <= kAllFacts; ++facts)
      EXPECT_TRUE((facts & kReady) != 0 || next_mode(mode, facts) == Mode::kIdle) << text_of(mode) << " " << facts;
}

TEST(PlannerState, FollowsTheTable) {
  struct Row {
    Mode from;
    int facts;
    Mode to;
  };
  const std::vector<Row> expected = {
      {Mode::kIdle, kReady | kClear, Mode::kFollowing},
      {Mode::kIdle, kReady, Mode::kPlanning},
      {Mode::kFollowing, kReady | kClear, Mode::kFollowing},
      {Mode::kFollowing, kReady | kClear | kFailed | kCanBackUp, Mode::kFollowing},
      {Mode::kFollowing, kReady, Mode::kPlanning},
      {Mode::kFollowing, kReady | kClear | kBackUpWanted | kCanBackUp, Mode::kBackingUp},
      {Mode::kFollowing, kReady | kClear | kBackUpWanted | kCannotBackUp, Mode::kNoPath},
      {Mode::kFollowing, kReady | kClear | kBackUpWanted, Mode::kFollowing},
      {Mode::kPlanning, kReady, Mode::kPlanning},
      {Mode::kPlanning, kReady | kClear, Mode::kFollowing},
      {Mode::kPlanning, kReady | kFailed | kCanBackUp, Mode::kBackingUp},
      {Mode::kPlanning, kReady | kCanBackUp, Mode::kPlanning},
      {Mode::kPlanning, kReady | kClear | kBackUpWanted | kCannotBackUp, Mode::kNoPath},
      {Mode::kPlanning, kReady | kClear | kBackUpWanted, Mode::kPlanning},
      {Mode::kPlanning, kReady | kFailed | kCannotBackUp, Mode::kNoPath},
      {Mode::kPlanning, kReady | kFailed, Mode::kPlanning},
      {Mode::kPlanning, kReady | kFailed | kClear, Mode::kFollowing},
      {Mode::kBackingUp, kReady, Mode::kBackingUp},
      {Mode::kBackingUp, kReady | kClear, Mode::kBackingUp},
      {Mode::kBackingUp, kReady | kBackedUp, Mode::kPlanning},
      {Mode::kNoPath, kReady, Mode::kNoPath},
      {Mode::kNoPath, kReady | kFailed | kCanBackUp, Mode::kNoPath},
      {Mode::kNoPath, kReady | kClear, Mode::kFollowing},
      {Mode::kNoPath, kReady | kClear | kBackUpWanted | kNewLevel, Mode::kNoPath},
      {Mode::kNoPath, kReady | kNewLevel, Mode::kPlanning},
      {Mode::kNoPath, kReady | kBackUpWanted | kCanBackUp, Mode::kBackingUp},
  };
  for (const Row& row : expected)
    EXPECT_EQ(text_of(next_mode(row.from, static_cast<std::uint16_t>(row.facts))), std::string(text_of(row.to)))
        << text_of(row.from) << " " << row.facts;
}

TEST(PlannerState, TheDrawingInTheReadmeHasTheArrowsOfTheTable) {
  using Arrow = std::pair<std::string, std::string>;
  std::set<Arrow> table;
  for (const Transition& row : transitions()) table.emplace(text_of(row.from), text_of(row.to));
  std::set<Arrow> drawn;
  std::ifstream readme(ROVER_SOURCE_DIR "/services/path_planner/README.md");
  for (std::string line; std::getline(readme, line) && line != "stateDiagram-v2";) continue;
  for (std::string line; std::getline(readme, line) && line != "```";) {
    std::istringstream words(line);
    std::string from, arrow, to;
    words >> from >> arrow >> to;
    drawn.emplace(from, to.substr(0, to.find(':')));
  }
  EXPECT_EQ(drawn, table);
}

}  // namespace
}  // namespace rover::planning
