#include "common/core/lease.hpp"

#include <cmath>

namespace rover {

bool is_fresh(Utime utime, Utime valid_until, Utime now, Utime max_age) {
  return utime >= 0 && utime <= now && now - utime <= max_age && now <= valid_until;
}

bool permit_valid(const DrivePermit& permit, Utime now, Utime max_age) {
  return permit.granted && std::isfinite(permit.max_speed_mps) && permit.max_speed_mps > 0.0 &&
         permit.valid_until > permit.utime && is_fresh(permit.utime, permit.valid_until, now, max_age);
}

bool command_valid(const MotionCommand& command, Utime now, Utime max_age) {
  return std::isfinite(command.speed_mps) && std::isfinite(command.curvature_per_m) &&
         std::isfinite(command.turn_rate_radps) && command.valid_until > command.utime &&
         is_fresh(command.utime, command.valid_until, now, max_age);
}

}  // namespace rover
