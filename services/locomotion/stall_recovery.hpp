// Stall recovery of a steering servo that cannot push its wheel past a rock: after a wait the rover rolls slowly with
// the angles it has, which lets the wheel climb or leave the rock. It gives up after max_distance_m.
#pragma once

#include "common/core/frames.hpp"

namespace rover::locomotion {

struct StallRecoveryConfig {
  double wait_s = 0.5;                       // setpoints reached, wheels not; an unobstructed wheel lags by 0.1 s
  double max_mean_error_rad = to_rad(30.0);  // mean of four: beyond it the wheels would scrub too much
  double speed_mps = 0.04;
  double max_distance_m = 0.20;  // more than the wheel radius (0.125 m)
};

class StallRecovery {
 public:
  explicit StallRecovery(const StallRecoveryConfig& config) : config_(config) {}

  // One tick of waiting for the steering: returns the allowed speed, 0 while waiting and after giving up.
  double recovery_speed_mps(double mean_error_rad, double motion_mps, double dt_s);
  // Call when the steering is aligned.
  void reset() { waited_s_ = rolled_m_ = 0.0; }

 private:
  StallRecoveryConfig config_;
  double waited_s_ = 0.0;
  double rolled_m_ = 0.0;
};

}  // namespace rover::locomotion
