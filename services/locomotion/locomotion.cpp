#include "locomotion/locomotion.hpp"

#include <algorithm>
#include <cmath>

namespace rover::locomotion {
namespace {

constexpr double kMaxStepS = 0.1;  // ramps do not leap after a gap in the ticks

// Arrives exactly: rest and alignment are tested for equality.
double move_towards(double from, double to, double step) {
  if (std::abs(to - from) <= step) return to;
  return from + std::copysign(step, to - from);
}

// 1 up to `slow`, falling to 0 at `stop`.
double falling(double value, double slow, double stop) {
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
      curvature_rate_(config.steering_rate_share * vehicle.steer_rate_radps /
                      steepest_steering(vehicle, config.max_curvature_per_m)),
      turn_radius_m_(point_turn_radius_m(vehicle)),
      stall_(config.stall) {}

WheelCommand Locomotion::step(Utime now, const MotionCommand& command, const DrivePermit& permit,
                              const WheelReading& wheels) {
  const double dt_s = last_step_ == kNever ? 0.0 : std::min(to_seconds(now - last_step_), kMaxStepS);
  last_step_ = now;
  WheelCommand out;
  const bool wheels_known = usable(wheels, now);
  const Utime max_age = to_utime(config_.lease_max_age_s);
  out.lease = wheels_known && permits(permit, now, max_age) && commands(command, now, max_age);
  if (wheels_known && !started_) {
    steer_rad_ = wheels.steer_angle_rad;
    started_ = true;
  }
  if (wheels_known && wheels.command_expired) motion_mps_ = 0.0;
  if (out.lease) {
    if (held_) go_on(wheels);
    out.state = drive(target_of(command, permit), wheels, dt_s);
  } else {
    ramp(0.0, config_.emergency_deceleration_mps2, dt_s);
    if (wheels_known && motion_mps_ == 0.0) rest(wheels, dt_s);
  }
  out.valid = started_ && wheels_known;
  out.wheels = setpoints();
  out.steering_error_rad = wheels_known ? steering_error(wheels) : 0.0;
  return out;
}

// Not held anew at each tick: angles that give way a little would creep on.
void Locomotion::rest(const WheelReading& wheels, double dt_s) {
  pushed_off_s_ = held_ && steering_error(wheels) > config_.hold_slack_rad ? pushed_off_s_ + dt_s : 0.0;
  if (!held_ || pushed_off_s_ > config_.hold_patience_s) hold(wheels);
}

void Locomotion::hold(const WheelReading& wheels) {
  held_ = true;
  pushed_off_s_ = 0.0;
  steer_rad_ = wheels.steer_angle_rad;
}

void Locomotion::go_on(const WheelReading& wheels) {
  held_ = false;
  stall_.clear();
  const auto wanted = geometry_angles();
  aligned_ = aligned_ && largest_difference(wanted, wheels.steer_angle_rad) <= config_.aligned_rad;
  if (aligned_) steer_rad_ = wanted;
}

LocomotionState Locomotion::drive(const Target& target, const WheelReading& wheels, double dt_s) {
  steer(target, wheels, dt_s);
  const double freeing_mps = std::min(freeing_speed_mps(target, wheels, dt_s), std::abs(target.motion_mps));
  const bool steered = aligned_ && target.geometry == geometry_;
  const double allowed_mps = steered ? std::abs(target.motion_mps) * allowed_share(target, wheels) : 0.0;
  const bool may_roll = steered || freeing_mps > 0.0;
  ramp(std::copysign(std::max(allowed_mps, freeing_mps), target.motion_mps), config_.acceleration_mps2, dt_s);
  return may_roll ? LocomotionState::kDriving : LocomotionState::kAligning;
}

double Locomotion::freeing_speed_mps(const Target& target, const WheelReading& wheels, double dt_s) {
  const double error = steering_error(wheels);
  if (error <= config_.aligned_rad) stall_.clear();
  const bool steering_done =
      target.geometry == geometry_ && curvature_per_m_ == target.curvature_per_m && steer_rad_ == geometry_angles();
  if (!steering_done || error <= config_.aligned_rad) return 0.0;
  return stall_.freeing_speed_mps(mean_difference(steer_rad_, wheels.steer_angle_rad), motion_mps_, dt_s);
}

bool Locomotion::usable(const WheelReading& wheels, Utime now) const {
  return wheels.utime >= 0 && wheels.utime <= now && now - wheels.utime <= to_utime(config_.wheel_state_max_age_s) &&
         !wheels.fault && finite(wheels.steer_angle_rad);
}

Locomotion::Target Locomotion::target_of(const MotionCommand& command, const DrivePermit& permit) const {
  if (command.mode == MotionMode::kArc) {
    const double limit = std::min(vehicle_.top_speed_mps, permit.max_speed_mps);
    const double curvature =
        std::clamp(command.curvature_per_m, -config_.max_curvature_per_m, config_.max_curvature_per_m);
    return {Geometry::kArc, std::clamp(command.speed_mps, -limit, limit), curvature};
  }
  if (command.mode == MotionMode::kPointTurn) {
    const double limit = config_.max_turn_rate_radps;
    return {Geometry::kPointTurn, std::clamp(command.turn_rate_radps, -limit, limit) * turn_radius_m_, 0.0};
  }
  return {geometry_, 0.0, curvature_per_m_};
}

void Locomotion::steer(const Target& target, const WheelReading& wheels, double dt_s) {
  if (target.geometry != geometry_ && motion_mps_ == 0.0) switch_geometry(target);
  if (target.geometry != geometry_) return;
  if (!aligned_) {
    align(target, wheels, dt_s);
  } else if (geometry_ == Geometry::kArc) {
    curvature_per_m_ = move_towards(curvature_per_m_, target.curvature_per_m, curvature_rate_ * dt_s);
    steer_rad_ = geometry_angles();
  }
}

void Locomotion::switch_geometry(const Target& target) {
  geometry_ = target.geometry;
  aligned_ = false;
}

void Locomotion::align(const Target& target, const WheelReading& wheels, double dt_s) {
  curvature_per_m_ = target.curvature_per_m;
  const auto wanted = geometry_angles();
  const double step = vehicle_.steer_rate_radps * dt_s;
  for (size_t k = 0; k < 4; ++k) steer_rad_[k] = move_towards(steer_rad_[k], wanted[k], step);
  aligned_ = steer_rad_ == wanted && steering_error(wheels) <= config_.aligned_rad;
}

double Locomotion::steering_error(const WheelReading& wheels) const {
  return largest_difference(steer_rad_, wheels.steer_angle_rad);
}

double Locomotion::allowed_share(const Target& target, const WheelReading& wheels) const {
  const double steering = falling(steering_error(wheels), config_.steering_slow_rad, config_.steering_stop_rad);
  const double behind = std::abs(target.curvature_per_m - curvature_per_m_);
  return steering * falling(behind, config_.curvature_slow_per_m, config_.curvature_stop_per_m);
}

void Locomotion::ramp(double motion_mps, double rate_mps2, double dt_s) {
  motion_mps_ = move_towards(motion_mps_, motion_mps, rate_mps2 * dt_s);
}

WheelSetpoints Locomotion::rolling(double motion_mps) const {
  return geometry_ == Geometry::kArc ? arc_setpoints(vehicle_, motion_mps, curvature_per_m_)
                                     : point_turn_setpoints(vehicle_, motion_mps / turn_radius_m_);
}

WheelSetpoints Locomotion::setpoints() const {
  WheelSetpoints out = rolling(motion_mps_);
  out.steer_angle_rad = steer_rad_;
  return out;
}

}  // namespace rover::locomotion
