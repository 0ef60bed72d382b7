// Tangential force between wheel and soil: a brush with relaxation length. One bristle per wheel, deflected by d:
//   dd/dt = v_slip - |w R| d / sigma,    F = -N mu(|d| / sigma) d / |d| - c dd/dt
// In steady driving |d| / sigma is the slip, so mu is the inverse of the measured slope-slip table; at standstill the
// bristle is a spring that holds (Dahl and LuGre friction work the same way). Rolling resistance is a force against the
// wheel's travel, chosen so that level ground gives the table's slip at 0 degrees.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "rover_simulator/world/surface.hpp"

namespace rover {

struct WheelSoilConfig {
  double relaxation_m = 0.02;        // sigma
  double damping_spm = 4.0;          // c, per newton of load
  double lateral_factor = 0.9;       // sideways force over lengthwise force at the same slip
  double rolling_speed_mps = 0.002;  // below it rolling resistance fades to none
  double scrub_arm_m = 0.03;         // a wheel that turns on the spot rubs with mu times this arm [est]
  double scrub_rate_radps = 0.1;     // below it scrubbing fades
};

// Traction over load at this slip, rolling resistance included: mu, piecewise linear through the table's points.
double gross_traction(Soil soil, double slip);
// Force over load that rolling costs.
double rolling_resistance(Soil soil);
// Means over the soils under a wheel.
double gross_traction(const std::array<double, 3>& soil_share, double slip);
double rolling_resistance(const std::array<double, 3>& soil_share);

// Against the wheel's travel, through its axle: the ground before the wheel pushes radially.
double rolling_force(const WheelSoilConfig& config, const std::array<double, 3>& soil_share, double load_n,
                     double along_mps);
// Against a wheel that turns on the spot.
double scrub_torque(const WheelSoilConfig& config, const std::array<double, 3>& soil_share, double load_n,
                    double turn_radps);

class Bristle {
 public:
  // Velocities of the contact point along and across the wheel; returns the force on the rim, same axes.
  Eigen::Vector2d step(const WheelSoilConfig& config, const std::array<double, 3>& soil_share, double load_n,
                       double along_mps, double across_mps, double rim_speed_mps, double dt_s);
  void release() { deflection_m_.setZero(); }

 private:
  Eigen::Vector2d deflection_m_ = Eigen::Vector2d::Zero();
};

}  // namespace rover
