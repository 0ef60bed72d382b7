#include "locomotion/locomotion.hpp"

#include <algorithm>
#include <cmath>

namespace rover::locomotion {
namespace {

constexpr double kMaxStepS = 0.1;  // limits ramp steps after a gap in the ticks

// Reaches `to` exactly, because standstill and alignment are tested for equality.
double move_towards(double from, double to, double step) {
  if (std::abs(to - from) <= step) return to;
  return from + std::copysign(step, to - from);
}

// 1 up to `slow`, then linear to 0 at `stop`.
double linear_falloff(double value, double slow, double stop) {
  return std::clamp((stop - value) / (stop - slow), 0.0, 1.0);
}

double mean_difference(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  double sum = 0.0;
  for (size_t k = 0; k < 4; ++k) sum += std::abs(a[k] - b[k]);
  return sum / 4.0;
}

double largest_difference(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  double largest = 0.0;
  for (size_t k = 0; k < 4; ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

bool finite(const std::array<double, 4>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace

Locomotion::Locomotion(const LocomotionConfig& config, const Vehicle& vehicle)
    : config_(config),
      vehicle_(vehicle),
      max_curvature_rate_(config.steering_rate_ratio * vehicle.steer_rate_radps /
                          max_steering_gradient(vehicle, config.max_curvature_per_m)),
      turn_radius_m_(point_turn_radius_m(vehicle)),
      stall_recovery_(config.stall) {}

WheelCommand Locomotion::step(Utime now, const MotionCommand& command, const DrivePermit& permit,
                              const WheelReading& wheels) {
  const double dt_s = last_step_ == kNever ? 0.0 : std::min(to_seconds(now - last_step_), kMaxStepS);
  last_step_ = now;
  WheelCommand out;
  const bool wheels_usable = usable(wheels, now);
  const Utime max_age = to_utime(config_.lease_max_age_s);
  out.lease = wheels_usable && permit_valid(permit, now, max_age) && command_valid(command, now, max_age);
  if (wheels_usable && !initialised_) {
    steer_rad_ = wheels.steer_angle_rad;
    initialised_ = true;
  }
  if (wheels_usable && wheels.command_expired) motion_mps_ = 0.0;
  if (out.lease) {
    if (holding_) resume(wheels);
    out.state = drive(target_from(command, permit), wheels, dt_s);
  } else {
    ramp(0.0, config_.emergency_deceleration_mps2, dt_s);
    if (wheels_usable && motion_mps_ == 0.0) update_hold(wheels, dt_s);
  }
  out.valid = initialised_ && wheels_usable;
  out.wheels = setpoints();
  out.steering_error_rad = wheels_usable ? steering_error(wheels) : 0.0;
  return out;
}

// Held angles are not refreshed every tick: a slowly yielding wheel would creep away.
void Locomotion::update_hold(const WheelReading& wheels, double dt_s) {
  deflected_s_ = holding_ && steering_error(wheels) > config_.hold_tolerance_rad ? deflected_s_ + dt_s : 0.0;
  if (!holding_ || deflected_s_ > config_.hold_delay_s) hold_measured_angles(wheels);
}

void Locomotion::hold_measured_angles(const WheelReading& wheels) {
  holding_ = true;
  deflected_s_ = 0.0;
  steer_rad_ = wheels.steer_angle_rad;
}

void Locomotion::resume(const WheelReading& wheels) {
  holding_ = false;
  stall_recovery_.reset();
  const auto desired = desired_angles();
  aligned_ = aligned_ && largest_difference(desired, wheels.steer_angle_rad) <= config_.alignment_tolerance_rad;
  if (aligned_) steer_rad_ = desired;
}

LocomotionState Locomotion::drive(const Target& target, const WheelReading& wheels, double dt_s) {
  steer(target, wheels, dt_s);
  const double recovery_mps = std::min(recovery_speed_mps(target, wheels, dt_s), std::abs(target.motion_mps));
  const bool steering_ready = aligned_ && target.geometry == geometry_;
  const double allowed_mps = steering_ready ? std::abs(target.motion_mps) * speed_factor(target, wheels) : 0.0;
  const bool may_roll = steering_ready || recovery_mps > 0.0;
  ramp(std::copysign(std::max(allowed_mps, recovery_mps), target.motion_mps), config_.acceleration_mps2, dt_s);
  return may_roll ? LocomotionState::kDriving : LocomotionState::kAligning;
}

double Locomotion::recovery_speed_mps(const Target& target, const WheelReading& wheels, double dt_s) {
  const double error = steering_error(wheels);
  if (error <= config_.alignment_tolerance_rad) stall_recovery_.reset();
  const bool setpoints_reached =
      target.geometry == geometry_ && curvature_per_m_ == target.curvature_per_m && steer_rad_ == desired_angles();
  if (!setpoints_reached || error <= config_.alignment_tolerance_rad) return 0.0;
  return stall_recovery_.recovery_speed_mps(mean_difference(steer_rad_, wheels.steer_angle_rad), motion_mps_, dt_s);
}

bool Locomotion::usable(const WheelReading& wheels, Utime now) const {
  return wheels.utime >= 0 && wheels.utime <= now && now - wheels.utime <= to_utime(config_.wheel_state_max_age_s) &&
         !wheels.fault && finite(wheels.steer_angle_rad);
}

Locomotion::Target Locomotion::target_from(const MotionCommand& command, const DrivePermit& permit) const {
  const double limit_mps = std::min(vehicle_.top_speed_mps, permit.max_speed_mps);
  if (command.mode == MotionMode::kArc) {
    const double curvature =
        std::clamp(command.curvature_per_m, -config_.max_curvature_per_m, config_.max_curvature_per_m);
    return {Geometry::kArc, std::clamp(command.speed_mps, -limit_mps, limit_mps), curvature};
  }
  if (command.mode == MotionMode::kPointTurn) {
    const double limit_radps = config_.max_turn_rate_radps;
    const double wheel_mps = std::clamp(command.turn_rate_radps, -limit_radps, limit_radps) * turn_radius_m_;
    return {Geometry::kPointTurn, std::clamp(wheel_mps, -limit_mps, limit_mps), 0.0};
  }
  return {geometry_, 0.0, curvature_per_m_};
}

void Locomotion::steer(const Target& target, const WheelReading& wheels, double dt_s) {
  if (target.geometry != geometry_ && motion_mps_ == 0.0) set_geometry(target);
  if (target.geometry != geometry_) return;
  if (!aligned_) {
    align(target, wheels, dt_s);
  } else if (geometry_ == Geometry::kArc) {
    curvature_per_m_ = move_towards(curvature_per_m_, target.curvature_per_m, max_curvature_rate_ * dt_s);
    steer_rad_ = desired_angles();
  }
}

void Locomotion::set_geometry(const Target& target) {
  geometry_ = target.geometry;
  aligned_ = false;
}

void Locomotion::align(const Target& target, const WheelReading& wheels, double dt_s) {
  curvature_per_m_ = target.curvature_per_m;
  const auto desired = desired_angles();
  const double step = vehicle_.steer_rate_radps * dt_s;
  for (size_t k = 0; k < 4; ++k) steer_rad_[k] = move_towards(steer_rad_[k], desired[k], step);
  aligned_ = steer_rad_ == desired && steering_error(wheels) <= config_.alignment_tolerance_rad;
}

double Locomotion::steering_error(const WheelReading& wheels) const {
  return largest_difference(steer_rad_, wheels.steer_angle_rad);
}

double Locomotion::speed_factor(const Target& target, const WheelReading& wheels) const {
  const double steering_factor =
      linear_falloff(steering_error(wheels), config_.steering_slow_rad, config_.steering_stop_rad);
  const double curvature_error = std::abs(target.curvature_per_m - curvature_per_m_);
  return steering_factor * linear_falloff(curvature_error, config_.curvature_slow_per_m, config_.curvature_stop_per_m);
}

void Locomotion::ramp(double motion_mps, double rate_mps2, double dt_s) {
  motion_mps_ = move_towards(motion_mps_, motion_mps, rate_mps2 * dt_s);
}

WheelSetpoints Locomotion::wheel_setpoints(double motion_mps) const {
  return geometry_ == Geometry::kArc ? arc_setpoints(vehicle_, motion_mps, curvature_per_m_)
                                     : point_turn_setpoints(vehicle_, motion_mps / turn_radius_m_);
}

WheelSetpoints Locomotion::setpoints() const {
  WheelSetpoints out = wheel_setpoints(motion_mps_);
  out.steer_angle_rad = steer_rad_;
  return out;
}

}  // namespace rover::locomotion
