// Message time in microseconds, advanced by TICK. Cores use no other clock.
#pragma once

#include <cstdint>

namespace rover {

using Utime = std::int64_t;

constexpr Utime kTickUs = 20'000;
constexpr Utime kNever = -1;

constexpr double to_seconds(Utime us) {
  return static_cast<double>(us) * 1e-6;
}
constexpr Utime to_utime(double seconds) {
  return static_cast<Utime>(seconds * 1e6 + (seconds < 0 ? -0.5 : 0.5));
}

}  // namespace rover
