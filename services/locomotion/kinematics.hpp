// Inverse kinematics of the double Ackermann rover: four steered corner wheels, two fixed middle wheels.
//
// A wheel at p = (x, y) of a body that moves with speed v along x and turns at w rolls with (v - w y, w x). All wheels
// roll about one centre of rotation on the axis of the middle wheels, so none scrubs. (Siegwart and Nourbakhsh,
// Introduction to Autonomous Mobile Robots, ch. 3.)
#pragma once

#include <array>

#include "common/core/vehicle.hpp"

namespace rover::locomotion {

struct WheelSetpoints {
  std::array<double, 6> drive_rate_radps{};  // FL FR ML MR RL RR
  std::array<double, 4> steer_angle_rad{};   // FL FR RL RR, positive left
};

// Of the body origin; the radius has to be larger than the half track, so that no wheel turns backwards.
WheelSetpoints arc_setpoints(const Vehicle& vehicle, double speed_mps, double curvature_per_m);
// About the body origin. The angles do not depend on the rate; left wheels run backwards for a positive rate.
WheelSetpoints point_turn_setpoints(const Vehicle& vehicle, double turn_rate_radps);

// Distance of the outermost wheel from the body origin: its speed in a point turn is this times the rate.
double point_turn_radius_m(const Vehicle& vehicle);
// Largest change of a steering angle for a change of curvature, over all curvatures up to the given one [rad m].
double steepest_steering(const Vehicle& vehicle, double max_curvature_per_m);

}  // namespace rover::locomotion
