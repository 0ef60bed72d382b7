// Wheel controller: converts a body motion under a lease into rate-limited wheel rates and steering angles.
//
// While rolling it interpolates the curvature, not single wheel angles, so all wheels share one centre of rotation.
// To switch between arc and point turn the rover stops until the wheels are aligned.
// Without a lease a stationary rover holds the measured steering angles, so no servo pushes against an obstacle.
#pragma once

#include <array>
#include <cstdint>

#include "common/core/frames.hpp"
#include "common/core/lease.hpp"
#include "common/core/vehicle.hpp"
#include "common/core/wheel_kinematics.hpp"
#include "locomotion/stall_recovery.hpp"

namespace rover::locomotion {

struct LocomotionConfig {
  double lease_max_age_s = 0.2;  // of permit and command
  double wheel_state_max_age_s = 0.2;
  double acceleration_mps2 = 0.118;          // also the deceleration of a commanded stop [HDPR]
  double emergency_deceleration_mps2 = 0.4;  // without a lease: 0.2 m/s to rest in 0.5 s and 0.05 m
  double steering_rate_ratio = 0.9;          // of the motor rate, while rolling: margin for tracking
  double max_curvature_per_m = 1.0;
  double max_turn_rate_radps = to_rad(14.0);
  double alignment_tolerance_rad = to_rad(3.0);  // steering aligned, motion may start
  double steering_slow_rad = to_rad(4.0);        // steering error: speed reduced from here
  double steering_stop_rad = to_rad(10.0);       // speed zero
  double hold_tolerance_rad = to_rad(1.5);       // deflection of a held wheel ...
  double hold_delay_s = 1.0;                     // ... that for this time resets the held angle to the measured one
  double curvature_slow_per_m = 0.20;            // same two limits for the curvature error
  double curvature_stop_per_m = 1.00;
  StallRecoveryConfig stall;
};

struct WheelReading {
  Utime utime = kNever;
  std::array<double, 4> steer_angle_rad{};
  bool fault = false;
  bool command_expired = false;  // the driver stopped the wheels: WHEEL_COMMAND expired
};

enum class LocomotionState { kHolding, kDriving, kAligning };

struct WheelCommand {
  bool valid = false;  // false: wheel state unknown, the driver must keep the wheels stopped
  WheelSetpoints wheels;
  LocomotionState state = LocomotionState::kHolding;
  bool lease = false;
  double steering_error_rad = 0.0;
};

class Locomotion {
 public:
  Locomotion(const LocomotionConfig& config, const Vehicle& vehicle);

  // One control tick; arguments are the newest messages received.
  WheelCommand step(Utime now, const MotionCommand& command, const DrivePermit& permit, const WheelReading& wheels);

 private:
  enum class Geometry { kArc, kPointTurn };
  struct Target {
    Geometry geometry;
    double motion_mps;  // speed of the body origin (arc) or of the outermost wheel (point turn)
    double curvature_per_m;
  };

  LocomotionState drive(const Target& target, const WheelReading& wheels, double dt_s);
  void update_hold(const WheelReading& wheels, double dt_s);
  void hold_measured_angles(const WheelReading& wheels);
  void resume(const WheelReading& wheels);
  double recovery_speed_mps(const Target& target, const WheelReading& wheels, double dt_s);
  bool usable(const WheelReading& wheels, Utime now) const;
  Target target_from(const MotionCommand& command, const DrivePermit& permit) const;
  void steer(const Target& target, const WheelReading& wheels, double dt_s);
  void align(const Target& target, const WheelReading& wheels, double dt_s);
  void set_geometry(const Target& target);
  double speed_factor(const Target& target, const WheelReading& wheels) const;
  double steering_error(const WheelReading& wheels) const;
  void ramp(double motion_mps, double rate_mps2, double dt_s);
  // For the current geometry and curvature.
  WheelSetpoints wheel_setpoints(double motion_mps) const;
  std::array<double, 4> desired_angles() const { return wheel_setpoints(0.0).steer_angle_rad; }
  WheelSetpoints setpoints() const;

  LocomotionConfig config_;
  Vehicle vehicle_;
  double max_curvature_rate_;  // that every steering motor can follow [1/(m s)]
  double turn_radius_m_;
  StallRecovery stall_recovery_;
  bool initialised_ = false;
  bool holding_ = false;  // steer_rad_ holds measured angles, not setpoints of the geometry
  double deflected_s_ = 0.0;
  Utime last_step_ = kNever;
  Geometry geometry_ = Geometry::kArc;
  bool aligned_ = false;
  double motion_mps_ = 0.0;
  double curvature_per_m_ = 0.0;
  std::array<double, 4> steer_rad_{};
};

}  // namespace rover::locomotion
