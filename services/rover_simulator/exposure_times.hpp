// When the simulator exposes its cameras, in message time.
#pragma once

#include "common/core/time.hpp"

namespace rover {

inline constexpr Utime kFirstTick = 1'000'000;  // and first LocCam pair; 0 means never
inline constexpr Utime kLocCamPeriod = 400'000;
inline constexpr Utime kCameraLatency = 60'000;  // exposure, read-out and transfer of a pair

}  // namespace rover
