// Drive and steering motors: servos with current limit, gear friction and torque-to-current model.
#pragma once

namespace rover {

struct DriveMotorConfig {
  double torque_per_amp_nm = 1.0;    // at the wheel: gear 100 x 0.014 Nm/A x 0.7 efficiency [est]
  double no_load_current_a = 0.5;    // friction of motor and gear [est]
  double rotor_inertia_kgm2 = 0.05;  // at the wheel
  double rate_gain_nms = 4.0;
  double angle_gain_nm = 80.0;  // on the integral of the rate error
};

struct SteerMotorConfig {
  double torque_per_amp_nm = 12.0;  // at the wheel's steering axis [est]
  double no_load_current_a = 0.2;
  double rotor_inertia_kgm2 = 0.1;
  double angle_gain_nm = 250.0;
  double rate_gain_nms = 10.0;
};

struct MotorOutput {
  double torque_nm = 0.0;  // on the joint
  double current_a = 0.0;
};

// Velocity servo on the integral of the commanded rate, so that a stopped wheel holds its angle.
class DriveMotor {
 public:
  MotorOutput step(const DriveMotorConfig& config, double limit_a, double rate_cmd_radps, double angle_rad,
                   double rate_radps, double dt_s);

 private:
  double lead_rad_ = 0.0;  // the reference's angle minus the wheel's
  double last_angle_rad_ = 0.0;
};

// Position servo with a rate-limited reference.
class SteerMotor {
 public:
  MotorOutput step(const SteerMotorConfig& config, double limit_a, double max_rate_radps, double angle_cmd_rad,
                   double angle_rad, double rate_radps, double dt_s);

 private:
  double reference_rad_ = 0.0;
};

}  // namespace rover
