// Tangential wheel-soil force: brush model with relaxation length. One bristle per wheel with deflection d:
//   dd/dt = v_slip - |w R| d / sigma,    F = -N mu(|d| / sigma) d / |d| - c dd/dt
// In steady state |d| / sigma is the slip, so mu is the inverse of the slope-slip table; at standstill the bristle is a
// spring (as in Dahl and LuGre friction). Rolling resistance gives the table's slip on level ground.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "rover_simulator/world/surface.hpp"

namespace rover {

struct WheelSoilConfig {
  double relaxation_m = 0.02;        // sigma
  double damping_spm = 4.0;          // c, per newton of load
  double lateral_factor = 0.9;       // sideways force over lengthwise force at the same slip
  double rolling_speed_mps = 0.002;  // rolling resistance is linear below this speed
  double scrub_arm_m = 0.03;         // scrub torque when steering on the spot = mu x load x this arm [est]
  double scrub_rate_radps = 0.1;     // scrub torque is linear below this rate
};

// Traction coefficient mu at this slip, including rolling resistance; piecewise linear through the table.
double gross_traction(Soil soil, double slip);
// Rolling resistance coefficient.
double rolling_resistance(Soil soil);
// Weighted means over the soils under a wheel.
double gross_traction(const std::array<double, 3>& soil_fraction, double slip);
double rolling_resistance(const std::array<double, 3>& soil_fraction);

// Resistance force at the axle, opposite to the direction of travel.
double rolling_force(const WheelSoilConfig& config, const std::array<double, 3>& soil_fraction, double load_n,
                     double along_mps);
// Resistance torque of a wheel steered on the spot.
double scrub_torque(const WheelSoilConfig& config, const std::array<double, 3>& soil_fraction, double load_n,
                    double turn_radps);

class Bristle {
 public:
  // Velocities of the contact point along and across the wheel; returns the force on the rim, same axes.
  Eigen::Vector2d step(const WheelSoilConfig& config, const std::array<double, 3>& soil_fraction, double load_n,
                       double along_mps, double across_mps, double rim_speed_mps, double dt_s);
  void release() { deflection_m_.setZero(); }

 private:
  Eigen::Vector2d deflection_m_ = Eigen::Vector2d::Zero();
};

}  // namespace rover
