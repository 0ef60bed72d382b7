#include "locomotion/stall_recovery.hpp"

#include <cmath>

namespace rover::locomotion {

double StallRecovery::recovery_speed_mps(double mean_error_rad, double motion_mps, double dt_s) {
  waited_s_ += dt_s;
  rolled_m_ += std::abs(motion_mps) * dt_s;
  const bool may_recover = mean_error_rad <= config_.max_mean_error_rad && rolled_m_ < config_.max_distance_m;
  return may_recover && waited_s_ >= config_.wait_s ? config_.speed_mps : 0.0;
}

}  // namespace rover::locomotion
