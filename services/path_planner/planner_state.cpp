#include "path_planner/planner_state.hpp"

namespace rover::planning {
namespace {

constexpr std::array kTransitions = {
    Transition{Mode::kFollowing, 0, kReady, Mode::kIdle},
    Transition{Mode::kPlanning, 0, kReady, Mode::kIdle},
    Transition{Mode::kBackingUp, 0, kReady, Mode::kIdle},
    Transition{Mode::kNoPath, 0, kReady, Mode::kIdle},
    Transition{Mode::kIdle, kReady | kClear, 0, Mode::kFollowing},
    Transition{Mode::kIdle, kReady, 0, Mode::kPlanning},
    Transition{Mode::kFollowing, kBackUpWanted | kCanBackUp, 0, Mode::kBackingUp},
    Transition{Mode::kFollowing, kBackUpWanted | kCannotBackUp, 0, Mode::kNoPath},
    Transition{Mode::kFollowing, 0, kClear, Mode::kPlanning},
    Transition{Mode::kPlanning, kBackUpWanted | kCanBackUp, 0, Mode::kBackingUp},
    Transition{Mode::kPlanning, kBackUpWanted | kCannotBackUp, 0, Mode::kNoPath},
    Transition{Mode::kPlanning, kClear, kBackUpWanted, Mode::kFollowing},
    Transition{Mode::kPlanning, kFailed | kCanBackUp, 0, Mode::kBackingUp},
    Transition{Mode::kPlanning, kFailed | kCannotBackUp, 0, Mode::kNoPath},
    Transition{Mode::kBackingUp, kBackedUp, 0, Mode::kPlanning},
    Transition{Mode::kNoPath, kBackUpWanted | kCanBackUp, 0, Mode::kBackingUp},
    Transition{Mode::kNoPath, kNewLevel, kBackUpWanted, Mode::kPlanning},
    Transition{Mode::kNoPath, kClear, kBackUpWanted, Mode::kFollowing},
};

}  // namespace

std::span<const Transition> transitions() {
  return kTransitions;
}

Mode next_mode(Mode mode, std::uint16_t facts) {
  for (const Transition& row : kTransitions)
    if (row.from == mode && (facts & row.required) == row.required && (facts & row.forbidden) == 0) return row.to;
  return mode;
}

const char* text_of(Mode mode) {
  constexpr std::array kTexts = {"IDLE", "FOLLOWING", "PLANNING", "BACKING_UP", "NO_PATH"};
  return kTexts[static_cast<size_t>(mode)];
}

}  // namespace rover::planning
