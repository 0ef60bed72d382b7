// What an operator's hand commands, within the rover's limits: arcs down to the least radius, point turns below it.
#pragma once

#include "common/core/time.hpp"
#include "locomotion/lease.hpp"
#include "trajectory_control/trajectory_controller.hpp"

namespace rover::control {

struct TeleopInput {
  Utime utime = kNever;  // of the operator's newest command
  double speed_mps = 0.0;
  double curvature_per_m = 0.0;  // left positive
};

// Stands still under a permit that is not fresh, a command that is too old, and numbers that are none.
MotionCommand teleop_command(Utime now, const TeleopInput& input, const DrivePermit& permit,
                             const TrajectoryControlConfig& config);

}  // namespace rover::control
