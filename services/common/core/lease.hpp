// Motion lease: the rover moves only with a valid drive permit and a valid motion command. Any doubt means no lease.
#pragma once

#include "common/core/time.hpp"

namespace rover {

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

// True if utime is at most max_age old and not in the future, and now <= valid_until. max_age bounds any publisher.
bool is_fresh(Utime utime, Utime valid_until, Utime now, Utime max_age);
bool permit_valid(const DrivePermit& permit, Utime now, Utime max_age);
bool command_valid(const MotionCommand& command, Utime now, Utime max_age);

}  // namespace rover
