// Wall clock of the tools. Services use message time.
#pragma once

#include <chrono>

namespace rover {

// Seconds of a steady clock.
inline double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace rover
