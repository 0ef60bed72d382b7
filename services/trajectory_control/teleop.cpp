#include "trajectory_control/teleop.hpp"

#include <algorithm>
#include <cmath>

namespace rover::control {

MotionCommand teleop_command(Utime now, const TeleopInput& input, const DrivePermit& permit,
                             const TrajectoryControlConfig& config) {
  MotionCommand out;
  out.utime = out.valid_until = now;
  const bool fresh = input.utime >= 0 && input.utime <= now && now - input.utime <= to_utime(config.teleop_max_age_s);
  const bool finite = std::isfinite(input.speed_mps) && std::isfinite(input.curvature_per_m);
  if (!fresh || !finite || !permit_valid(permit, now, to_utime(config.permit_max_age_s))) return out;
  out.valid_until = now + to_utime(config.command_validity_s);
  const double speed = std::clamp(input.speed_mps, -permit.max_speed_mps, permit.max_speed_mps);
  if (std::abs(input.curvature_per_m) > config.path.max_curvature_per_m) {
    out.mode = MotionMode::kPointTurn;
    out.turn_rate_radps =
        std::clamp(speed * input.curvature_per_m, -config.max_turn_rate_radps, config.max_turn_rate_radps);
  } else if (speed != 0.0) {
    out.mode = MotionMode::kArc;
    out.speed_mps = speed;
    out.curvature_per_m = input.curvature_per_m;
  }
  return out;
}

}  // namespace rover::control
