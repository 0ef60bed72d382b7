// What the supervisor needs of a path: the autonomy level along it, whether it leads back along the driven track, and
// the zones that come with it.
#pragma once

#include <cstdint>
#include <vector>

#include "common/core/zones.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct PathLevels {
  std::int64_t path_id = -1;
  std::vector<double> s_m;   // arc length of each point, increasing
  std::vector<Level> level;  // level from that point on
  bool backtrack = false;
  std::vector<Zone> zones;  // in odom

  // Efficient if unknown.
  Level at(double query_s_m) const {
    Level found = Level::kEfficient;
    for (size_t i = 0; i < s_m.size() && s_m[i] <= query_s_m; ++i) found = level[i];
    return found;
  }
};

}  // namespace rover::supervisor
