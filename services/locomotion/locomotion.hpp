// Drives the six wheels: from a body motion under a lease to wheel rates and steering angles, with ramps.
//
// While the rover rolls, the steering moves along the curvature, not wheel by wheel: at each moment all wheels share
// one centre of rotation. Between arc and point turn the rover stands until the wheels have reached their angles. A
// wheel that cannot, because it stands against a rock, is rolled on a little: that frees it (steering_stall.hpp).
// Without a lease a standing rover keeps the angles that its wheels have, not those that were asked for, nor those from
// which they have been pushed: no servo pushes on against what stopped it.
#pragma once

#include <array>
#include <cstdint>

#include "common/core/vehicle.hpp"
#include "locomotion/kinematics.hpp"
#include "locomotion/lease.hpp"
#include "locomotion/steering_stall.hpp"

namespace rover::locomotion {

struct LocomotionConfig {
  double lease_max_age_s = 0.2;  // of permit and command (blueprint, rule 5)
  double wheel_state_max_age_s = 0.2;
  double acceleration_mps2 = 0.118;          // both ways [HDPR]
  double emergency_deceleration_mps2 = 0.4;  // lease lost: 0.2 m/s to rest in 0.5 s and 5 cm
  double steering_rate_share = 0.9;          // of the motors' rate while rolling, so that they can follow
  double max_curvature_per_m = 1.0;
  double max_turn_rate_radps = 0.25;
  double aligned_rad = 0.052;        // 3 deg: the steering has arrived, motion may start
  double steering_slow_rad = 0.07;   // 4 deg behind: slower
  double steering_stop_rad = 0.175;  // 10 deg behind: wait
  double hold_slack_rad = 0.026;     // 1.5 deg: a wheel at rest that was pushed so far off for so long is held there
  double hold_patience_s = 1.0;
  double curvature_slow_per_m = 0.20;  // as above, of the commanded curvature not yet set
  double curvature_stop_per_m = 1.00;
  SteeringStallConfig stall;
};

struct WheelReading {
  Utime utime = kNever;
  std::array<double, 4> steer_angle_rad{};
  bool fault = false;
  bool command_expired = false;  // the driver has stopped the wheels by itself
};

enum class LocomotionState { kHolding, kDriving, kAligning };

struct WheelCommand {
  bool valid = false;  // false: nothing is known of the wheels, the driver shall keep them still
  WheelSetpoints wheels;
  LocomotionState state = LocomotionState::kHolding;
  bool lease = false;
  double steering_error_rad = 0.0;
};

class Locomotion {
 public:
  Locomotion(const LocomotionConfig& config, const Vehicle& vehicle);

  // One tick of dt; the three are the newest received.
  WheelCommand step(Utime now, const MotionCommand& command, const DrivePermit& permit, const WheelReading& wheels);

 private:
  enum class Geometry { kArc, kPointTurn };
  struct Target {
    Geometry geometry;
    double motion_mps;  // arc: of the body origin; point turn: of the outermost wheel
    double curvature_per_m;
  };

  LocomotionState drive(const Target& target, const WheelReading& wheels, double dt_s);
  void rest(const WheelReading& wheels, double dt_s);
  void hold(const WheelReading& wheels);
  void go_on(const WheelReading& wheels);
  double freeing_speed_mps(const Target& target, const WheelReading& wheels, double dt_s);
  bool usable(const WheelReading& wheels, Utime now) const;
  Target target_of(const MotionCommand& command, const DrivePermit& permit) const;
  void steer(const Target& target, const WheelReading& wheels, double dt_s);
  void align(const Target& target, const WheelReading& wheels, double dt_s);
  void switch_geometry(const Target& target);
  double allowed_share(const Target& target, const WheelReading& wheels) const;
  double steering_error(const WheelReading& wheels) const;
  void ramp(double motion_mps, double rate_mps2, double dt_s);
  // Of the present geometry and curvature.
  WheelSetpoints rolling(double motion_mps) const;
  std::array<double, 4> geometry_angles() const { return rolling(0.0).steer_angle_rad; }
  WheelSetpoints setpoints() const;

  LocomotionConfig config_;
  Vehicle vehicle_;
  double curvature_rate_;  // that no steering motor is too slow for [1/(m s)]
  double turn_radius_m_;
  SteeringStall stall_;
  bool started_ = false;
  bool held_ = false;  // steer_rad_ are the angles that the wheels had when they came to rest
  double pushed_off_s_ = 0.0;
  Utime last_step_ = kNever;
  Geometry geometry_ = Geometry::kArc;
  bool aligned_ = false;
  double motion_mps_ = 0.0;
  double curvature_per_m_ = 0.0;
  std::array<double, 4> steer_rad_{};
};

}  // namespace rover::locomotion
