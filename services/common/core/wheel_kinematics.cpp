#include "common/core/wheel_kinematics.hpp"

#include <cmath>

#include "common/core/check.hpp"

namespace rover {
namespace {

struct WheelMotion {
  double angle_rad;
  double speed_mps;
};

// A steered wheel covers only half a revolution: a backward direction becomes the opposite angle with reversed speed.
WheelMotion to_steering_range(double along_mps, double left_mps) {
  const double speed = std::hypot(along_mps, left_mps);
  if (along_mps >= 0.0) return {std::atan2(left_mps, along_mps), speed};
  return {std::atan2(-left_mps, -along_mps), -speed};
}

}  // namespace

WheelSetpoints arc_setpoints(const Vehicle& vehicle, double speed_mps, double curvature_per_m) {
  WheelSetpoints out;
  std::array<double, 6> angle_rad{};
  for (size_t i = 0; i < 6; ++i) {
    const double along = 1.0 - curvature_per_m * vehicle.wheel_y_m[i];
    const double left = curvature_per_m * vehicle.wheel_x_m[i];
    ROVER_CHECK(along > 0.0, curvature_per_m, vehicle.wheel_y_m[i]);
    angle_rad[i] = std::atan2(left, along);
    out.drive_rate_radps[i] = speed_mps * std::hypot(along, left) / vehicle.wheel_radius_m;
  }
  for (size_t k = 0; k < 4; ++k) out.steer_angle_rad[k] = angle_rad[kSteeredWheels[k]];
  return out;
}

WheelSetpoints point_turn_setpoints(const Vehicle& vehicle, double turn_rate_radps) {
  WheelSetpoints out;
  std::array<WheelMotion, 6> unit_motion{};
  for (size_t i = 0; i < 6; ++i) {
    unit_motion[i] = to_steering_range(-vehicle.wheel_y_m[i], vehicle.wheel_x_m[i]);
    out.drive_rate_radps[i] = turn_rate_radps * unit_motion[i].speed_mps / vehicle.wheel_radius_m;
  }
  for (size_t k = 0; k < 4; ++k) out.steer_angle_rad[k] = unit_motion[kSteeredWheels[k]].angle_rad;
  return out;
}

double point_turn_radius_m(const Vehicle& vehicle) {
  double radius = 0.0;
  for (size_t i = 0; i < 6; ++i) radius = std::max(radius, std::hypot(vehicle.wheel_x_m[i], vehicle.wheel_y_m[i]));
  return radius;
}

double max_steering_gradient(const Vehicle& vehicle, double max_curvature_per_m) {
  // d/dk atan2(k x, 1 - k y) = x / (1 - 2 k y + k^2 (x^2 + y^2)), maximal at k = y / (x^2 + y^2) or at the bound.
  double steepest = 0.0;
  for (const int i : kSteeredWheels) {
    const double x = std::abs(vehicle.wheel_x_m[i]);
    const double y = std::abs(vehicle.wheel_y_m[i]);
    const double k = std::min(y / (x * x + y * y), max_curvature_per_m);
    steepest = std::max(steepest, x / (1.0 - 2.0 * k * y + k * k * (x * x + y * y)));
  }
  return steepest;
}

}  // namespace rover
