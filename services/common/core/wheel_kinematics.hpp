// Inverse kinematics of a double-Ackermann rover: four steered corner wheels, two fixed middle wheels. The contact
// point (x, y) moves with (v - w y, w x); all wheels have one centre of rotation on the axis of the middle wheels, so
// none slips sideways. Source: Siegwart and Nourbakhsh, Introduction to Autonomous Mobile Robots, ch. 3.
#pragma once

#include <array>

#include "common/core/vehicle.hpp"

namespace rover {

struct WheelSetpoints {
  std::array<double, 6> drive_rate_radps{};  // FL FR ML MR RL RR
  std::array<double, 4> steer_angle_rad{};   // FL FR RL RR, positive left
};

// Speed and curvature of the body origin. The radius must exceed half the track width (checked).
WheelSetpoints arc_setpoints(const Vehicle& vehicle, double speed_mps, double curvature_per_m);
// Rotation about the body origin. The angles do not depend on the rate; left wheels reverse for a positive rate.
WheelSetpoints point_turn_setpoints(const Vehicle& vehicle, double turn_rate_radps);

// Distance of the outermost wheel from the body origin: wheel speed = radius * turn rate.
double point_turn_radius_m(const Vehicle& vehicle);
// Largest |d angle / d curvature| of any steered wheel, for curvatures up to max_curvature_per_m [rad m].
double max_steering_gradient(const Vehicle& vehicle, double max_curvature_per_m);

}  // namespace rover
