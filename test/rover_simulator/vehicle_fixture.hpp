// The vehicle of config/vehicle.yaml, and surfaces with known answers.
#pragma once

#include <cmath>
#include <functional>

#include "common/core/frames.hpp"
#include "common/core/vehicle.hpp"
#include "rover_simulator/vehicle/vehicle_sim.hpp"

namespace rover {

inline Vehicle test_vehicle() {
  Vehicle v;
  v.origin_height_m = 0.62;
  v.body_mass_kg = 82.0;
  v.body_half_length_m = 0.60;
  v.body_half_width_m = 0.30;
  v.body_top_m = 0.25;
  v.belly_clearance_m = 0.30;
  v.wheel_radius_m = 0.125;
  v.wheel_width_m = 0.12;
  v.wheel_mass_kg = 2.0;
  v.wheel_x_m = {0.75, 0.75, 0.0, 0.0, -0.75, -0.75};
  v.wheel_y_m = {0.41, -0.41, 0.41, -0.41, 0.41, -0.41};
  v.steer_max_rad = to_rad(90.7);
  v.steer_rate_radps = to_rad(11.5);
  v.steer_current_nominal_a = 0.516;
  v.steer_current_limit_a = 1.0;
  v.gear_ratio = 100.0;
  v.drive_current_nominal_a = 3.17;
  v.drive_current_limit_a = 10.0;
  v.top_speed_mps = 0.2;
  v.deceleration_mps2 = 0.118;
  v.min_turn_radius_m = 1.0;
  v.max_climb_m = 0.20;
  v.hazard_height_m = 0.15;
  v.imu_position_m = {0.0, 0.0, 0.1};
  return v;
}

// A plane that rises towards +x.
class PlaneSurface : public Surface {
 public:
  PlaneSurface(Soil soil, double slope_rad) : soil_(soil), rise_(std::tan(slope_rad)) {}
  double height_m(double x_m, double) const override { return rise_ * x_m; }
  Material material(double, double) const override { return {soil_, -1, 0.0}; }

 private:
  Soil soil_;
  double rise_;
};

// Level firm ground with one rock-like feature given as its height over the ground.
class FeatureSurface : public Surface {
 public:
  explicit FeatureSurface(std::function<double(double, double)> feature) : feature_(std::move(feature)) {}
  double height_m(double x_m, double y_m) const override { return feature_(x_m, y_m); }
  Material material(double x_m, double y_m) const override {
    const double h = feature_(x_m, y_m);
    return h > 0.0 ? Material{Soil::kBedrock, 1, h} : Material{Soil::kFirm, -1, 0.0};
  }

 private:
  std::function<double(double, double)> feature_;
};

inline WheelCommand straight(double speed_mps) {
  WheelCommand command;
  command.drive_rate_radps.fill(speed_mps / 0.125);
  return command;
}

inline void drive(VehicleSim& sim, const WheelCommand& command, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / 0.02)); ++i) sim.advance(0.02, command);
}

}  // namespace rover
