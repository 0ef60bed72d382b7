// What the supervisor takes of a path: the level that it asks for along its way, and whether it is driven backwards.
#pragma once

#include <cstdint>
#include <vector>

#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct PathLevels {
  std::int64_t path_id = -1;
  std::vector<double> s_m;   // of each point, from the path's start, growing
  std::vector<Level> level;  // from that point on
  bool backwards = false;    // a way back, or a leg of a manoeuvre

  // Efficient where nothing is known.
  Level at(double s_m_wanted) const {
    Level found = Level::kEfficient;
    for (size_t i = 0; i < s_m.size() && s_m[i] <= s_m_wanted; ++i) found = level[i];
    return found;
  }
};

}  // namespace rover::supervisor
