// The states of the planner as one table.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace rover::planning {

enum class Mode : std::uint8_t { kIdle, kFollowing, kPlanning, kBackingUp, kNoPath };

enum Fact : std::uint16_t {
  kReady = 1 << 0,         // global path and fresh pose
  kClear = 1 << 1,         // the rover may go on along its path
  kFailed = 1 << 2,        // stationary, and several plans in a row were not found
  kCanBackUp = 1 << 3,     // there is a plan to back up
  kBackedUp = 1 << 4,      // at the end of a path to back up, or stopped on it
  kBackUpWanted = 1 << 5,  // by FDIR; stationary
  kNewLevel = 1 << 6,      // which sees other ground: what failed before may succeed
  kCannotBackUp = 1 << 7,  // there is no such plan, or it has been done too often
};

struct Transition {
  Mode from;
  std::uint16_t required;
  std::uint16_t forbidden;
  Mode to;
};

// The first row that fits fires; at most one a step.
std::span<const Transition> transitions();
Mode next_mode(Mode mode, std::uint16_t facts);
const char* text_of(Mode mode);

}  // namespace rover::planning
