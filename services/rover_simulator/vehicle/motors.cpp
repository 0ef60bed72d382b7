#include "rover_simulator/vehicle/motors.hpp"

#include <algorithm>
#include <cmath>

namespace rover {
namespace {

constexpr double kFrictionRate = 0.02;  // [rad/s] friction is linear below this rate, so a stop settles

// Limited current for the requested torque including gear friction, and the resulting torque.
MotorOutput limited(double torque_nm, double rate_radps, double torque_per_amp_nm, double no_load_a, double limit_a) {
  const double friction_a = no_load_a * std::tanh(rate_radps / kFrictionRate);
  const double current = std::clamp(torque_nm / torque_per_amp_nm + friction_a, -limit_a, limit_a);
  return {(current - friction_a) * torque_per_amp_nm, current};
}

}  // namespace

MotorOutput DriveMotor::step(const DriveMotorConfig& config, double limit_a, double rate_cmd_radps, double angle_rad,
                             double rate_radps, double dt_s) {
  lead_rad_ += rate_cmd_radps * dt_s - (angle_rad - last_angle_rad_);
  last_angle_rad_ = angle_rad;
  const double max_rad = limit_a * config.torque_per_amp_nm / config.angle_gain_nm;
  lead_rad_ = std::clamp(lead_rad_, -max_rad, max_rad);
  const double torque = config.rate_gain_nms * (rate_cmd_radps - rate_radps) + config.angle_gain_nm * lead_rad_;
  MotorOutput out = limited(torque, rate_radps, config.torque_per_amp_nm, config.no_load_current_a, limit_a);
  // At rest the gear is self-locking.
  if (rate_cmd_radps == 0.0 && std::abs(rate_radps) < kFrictionRate) out.current_a = 0.0;
  return out;
}

MotorOutput SteerMotor::step(const SteerMotorConfig& config, double limit_a, double max_rate_radps,
                             double angle_cmd_rad, double angle_rad, double rate_radps, double dt_s) {
  const double move = std::clamp(angle_cmd_rad - reference_rad_, -max_rate_radps * dt_s, max_rate_radps * dt_s);
  reference_rad_ += move;
  const double torque =
      config.angle_gain_nm * (reference_rad_ - angle_rad) + config.rate_gain_nms * (move / dt_s - rate_radps);
  return limited(torque, rate_radps, config.torque_per_amp_nm, config.no_load_current_a, limit_a);
}

}  // namespace rover
