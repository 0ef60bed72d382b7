#include "trajectory_control/config.hpp"

#include <algorithm>

#include "common/bus/navigation_config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/wheel_kinematics.hpp"

namespace rover::control {
namespace {

void apply_vehicle(const Vehicle& vehicle, TrajectoryControlConfig& out) {
  out.origin_height_m = vehicle.origin_height_m;
  out.path.max_curvature_per_m = out.steering.max_curvature_per_m = 1.0 / vehicle.min_turn_radius_m;
  out.path.cruise_speed_mps = vehicle.top_speed_mps;
  out.path.outer_wheel_x_m = *std::max_element(vehicle.wheel_x_m.begin(), vehicle.wheel_x_m.end());
  out.path.outer_wheel_y_m = *std::max_element(vehicle.wheel_y_m.begin(), vehicle.wheel_y_m.end());
}

void apply_navigation(const NavigationConfig& navigation, TrajectoryControlConfig& out) {
  out.turn_start_rad = navigation.point_turn_start_rad;
  out.turn_stop_rad = navigation.point_turn_stop_rad;
  out.teleop_max_age_s = navigation.teleop_max_age_s;
}

void add_smoother(Parameters p, SmootherConfig& c) {
  p.add("length_m", c.length_m, {0.05, 5.0}, "shorter features are smoothed away ...");
  p.add("max_distance_m", c.max_distance_m, {0.0, 0.5}, "... if the curve stays this close to the path");
}

void add_path(Parameters p, const Vehicle& vehicle, TrackedPathConfig& c) {
  double steering_rate_ratio = 0.9;
  p.add("max_wheel_speed_mps", c.max_wheel_speed_mps, {0.01, 2.0},
        "outer wheel; reached at 0.2 m/s body speed and a radius of 1.25 m");
  p.add("deceleration_mps2", c.deceleration_mps2, {0.01, vehicle.deceleration_mps2},
        "below the vehicle limit: margin for corrections");
  p.add("steering_rate_ratio", steering_rate_ratio, {0.1, 1.0}, "of the steering motor rate that a path may need");
  p.add("min_speed_mps", c.min_speed_mps, {0.01, 0.2}, "lower bound for slow-down due to curvature changes");
  p.add_deg("corner_deg", c.corner_rad, {5.0, 180.0},
            "angle between two chords of corner_chord_m from which the rover stops and turns on the spot");
  p.add("corner_chord_m", c.corner_chord_m, {0.05, 2.0}, "length of the chords before and after a point");
  add_smoother(p.section("smoother", "smoothing spline through the path"), c.smoother);
  c.max_curvature_rate =
      steering_rate_ratio * vehicle.steer_rate_radps / max_steering_gradient(vehicle, 1.0 / vehicle.min_turn_radius_m);
}

void add_steering(Parameters p, SteeringLawConfig& c) {
  p.add("length_m", c.length_m, {0.1, 5.0}, "decay length of the cross-track error");
  p.add("damping", c.damping, {0.3, 3.0}, "of the cross-track error");
  p.add("integral_per_m3", c.integral_per_m3, {0.0, 5.0},
        "gain on the cross track per distance: settles within about 5 m");
  p.add("max_integral_per_m", c.max_integral_per_m, {0.0, 1.0}, "limit of the integral");
  p.add("max_integrated_m", c.max_integrated_m, {0.0, 1.0},
        "anti-windup: the cross track is clamped to it before integration");
  p.add("max_cross_track_m", c.max_cross_track_m, {0.05, 5.0},
        "larger errors are approached at the same angle, 20 deg");
}

}  // namespace

TrajectoryControlConfig load_config(const std::string& config_dir, ParameterList* list) {
  const Vehicle vehicle = load_vehicle(config_dir);
  TrajectoryControlConfig c;
  apply_vehicle(vehicle, c);
  apply_navigation(load_navigation(config_dir), c);
  Parameters p(
      config_dir + "/trajectory_control.yaml",
      "Path following. Geometry, top speed, minimum radius and steering rate come from vehicle.yaml, the limits "
      "of point turns and teleoperation from navigation.yaml.",
      list);
  p.add("pose_max_age_s", c.pose_max_age_s, {0.02, 1.0}, "of POSE; older: no motion");
  p.add("permit_max_age_s", c.permit_max_age_s, {0.02, 0.2}, "of DRIVE_PERMIT; older: no motion");
  p.add("command_validity_s", c.command_validity_s, {0.02, 0.2}, "of MOTION_COMMAND");
  p.add("response_delay_s", c.response_delay_s, {0.0, 2.0},
        "from pose to wheel response: three ticks plus steering lag");
  p.add("end_tolerance_m", c.end_tolerance_m, {0.005, 0.5}, "about the stopping distance from the speed there");
  p.add("creep_speed_mps", c.creep_speed_mps, {0.005, 0.1}, "minimum speed, also just before the end");
  p.add("steering_distance_m", c.steering_distance_m, {0.02, 2.0},
        "travelled at most while the steering reaches the commanded curvature");
  p.add_deg("max_turn_rate_degps", c.max_turn_rate_radps, {0.5, 60.0}, "of point turns: outer wheels at top speed");
  p.add_deg("turn_deceleration_degps2", c.turn_deceleration_radps2, {0.5, 60.0}, "of point turns");
  p.add("look_ahead_m", c.look_ahead_m, {0.1, 10.0}, "prediction horizon of the corridor error (HDPR: 1.5 to 4 m)");
  p.add("side_slip_time_s", c.side_slip_time_s, {0.05, 20.0}, "low-pass time constant of the measured side slip");
  add_path(p.section("path", "reference trajectory: corners, speed profile, smoothing"), vehicle, c.path);
  add_steering(p.section("steering", "steering law"), c.steering);
  p.finish();
  return c;
}

}  // namespace rover::control
