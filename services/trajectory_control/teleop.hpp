// Converts operator commands into motion within the vehicle limits: arcs down to the minimum radius, else point turns.
#pragma once

#include "common/core/lease.hpp"
#include "common/core/time.hpp"
#include "trajectory_control/trajectory_controller.hpp"

namespace rover::control {

struct TeleopInput {
  Utime utime = kNever;  // of the newest operator command
  double speed_mps = 0.0;
  double curvature_per_m = 0.0;  // left positive
};

// Returns STOP without lease if the permit is invalid, the command is older than teleop_max_age_s, or a number is NaN.
MotionCommand teleop_command(Utime now, const TeleopInput& input, const DrivePermit& permit,
                             const TrajectoryControlConfig& config);

}  // namespace rover::control
