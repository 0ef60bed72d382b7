// Motion needs a lease: a drive permit and a motion command, both fresh. Anything doubtful is no lease.
#pragma once

#include "common/core/time.hpp"

namespace rover::locomotion {

enum class MotionMode : std::int8_t { kStop = 0, kArc = 1, kPointTurn = 2 };

struct MotionCommand {
  Utime utime = kNever;
  Utime valid_until = kNever;
  MotionMode mode = MotionMode::kStop;
  double speed_mps = 0.0;
  double curvature_per_m = 0.0;
  double turn_rate_radps = 0.0;
};

struct DrivePermit {
  Utime utime = kNever;
  Utime valid_until = kNever;
  bool granted = false;
  double max_speed_mps = 0.0;
};

// Valid at `now`, and from at most `max_age` before it, whatever its author wrote into valid_until.
bool is_fresh(Utime utime, Utime valid_until, Utime now, Utime max_age);
bool permits(const DrivePermit& permit, Utime now, Utime max_age);
bool commands(const MotionCommand& command, Utime now, Utime max_age);

}  // namespace rover::locomotion
