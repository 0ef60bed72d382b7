#include "locomotion/steering_stall.hpp"

#include <cmath>

namespace rover::locomotion {

double SteeringStall::freeing_speed_mps(double mean_error_rad, double motion_mps, double dt_s) {
  waited_s_ += dt_s;
  rolled_m_ += std::abs(motion_mps) * dt_s;
  const bool helps = mean_error_rad <= config_.most_mean_error_rad && rolled_m_ < config_.way_m;
  return helps && waited_s_ >= config_.patience_s ? config_.speed_mps : 0.0;
}

}  // namespace rover::locomotion
