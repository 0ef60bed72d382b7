#include "trajectory_control/config.hpp"

#include <algorithm>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/wheel_kinematics.hpp"

namespace rover::control {
namespace {

void read_vehicle(const Vehicle& vehicle, TrajectoryControlConfig& out) {
  out.path.max_curvature_per_m = out.steering.max_curvature_per_m = 1.0 / vehicle.min_turn_radius_m;
  out.path.cruise_speed_mps = vehicle.top_speed_mps;
  out.path.outer_wheel_x_m = *std::max_element(vehicle.wheel_x_m.begin(), vehicle.wheel_x_m.end());
  out.path.outer_wheel_y_m = *std::max_element(vehicle.wheel_y_m.begin(), vehicle.wheel_y_m.end());
}

void read_path(const Config& c, const Vehicle& vehicle, TrackedPathConfig& out) {
  double rate_share = 0.9;
  c.read("cruise_speed_mps", out.cruise_speed_mps, {0.01, vehicle.top_speed_mps});
  c.read("max_wheel_speed_mps", out.max_wheel_speed_mps, {0.01, 2.0});
  c.read("deceleration_mps2", out.deceleration_mps2, {0.01, vehicle.deceleration_mps2});
  c.read("steering_rate_share", rate_share, {0.1, 1.0});
  c.read("least_speed_mps", out.min_speed_mps, {0.01, 0.2});
  c.read("smoothing_length_m", out.smoother.length_m, {0.05, 5.0});
  c.read("smoothing_distance_m", out.smoother.max_distance_m, {0.0, 0.5});
  c.read_deg("kink_deg", out.corner_rad, {5.0, 180.0});
  c.read("kink_chord_m", out.corner_chord_m, {0.05, 2.0});
  out.max_curvature_rate =
      rate_share * vehicle.steer_rate_radps / max_steering_gradient(vehicle, 1.0 / vehicle.min_turn_radius_m);
}

void read_steering(const Config& c, SteeringLawConfig& out) {
  c.read("length_m", out.length_m, {0.1, 5.0});
  c.read("damping", out.damping, {0.3, 3.0});
  c.read("integral_per_m3", out.integral_per_m3, {0.0, 5.0});
  c.read("max_integral_per_m", out.max_integral_per_m, {0.0, 1.0});
  c.read("max_integrated_m", out.max_integrated_m, {0.0, 1.0});
  c.read("max_cross_track_m", out.max_cross_track_m, {0.05, 5.0});
}

void read_turning(const Config& c, TrajectoryControlConfig& out) {
  c.read_deg("start_deg", out.turn_start_rad, {5.0, 180.0});
  c.read_deg("stop_deg", out.turn_stop_rad, {0.2, 20.0});
  c.read_deg("max_rate_degps", out.max_turn_rate_radps, {0.5, 60.0});
  c.read_deg("deceleration_degps2", out.turn_deceleration_radps2, {0.5, 60.0});
  if (out.turn_start_rad <= out.turn_stop_rad) c.fail("start_deg", "must be larger than stop_deg");
}

}  // namespace

TrajectoryControlConfig load_config(const std::string& config_dir) {
  const Vehicle vehicle = load_vehicle(config_dir);
  TrajectoryControlConfig out;
  read_vehicle(vehicle, out);
  const Config config = Config::load(config_dir + "/trajectory_control.yaml");
  config.read("pose_max_age_s", out.pose_max_age_s, {0.02, 1.0});
  config.read("permit_max_age_s", out.permit_max_age_s, {0.02, 0.2});
  config.read("teleop_max_age_s", out.teleop_max_age_s, {0.1, 5.0});
  config.read("command_validity_s", out.command_validity_s, {0.02, 0.2});
  config.read("response_delay_s", out.response_delay_s, {0.0, 2.0});
  config.read("end_tolerance_m", out.end_tolerance_m, {0.005, 0.5});
  config.read("creep_speed_mps", out.creep_speed_mps, {0.005, 0.1});
  config.read("steering_way_m", out.steering_distance_m, {0.02, 2.0});
  config.read("look_ahead_m", out.look_ahead_m, {0.1, 10.0});
  config.read("side_slip_time_s", out.side_slip_time_s, {0.05, 20.0});
  read_path(config.section("path"), vehicle, out.path);
  read_steering(config.section("steering"), out.steering);
  read_turning(config.section("point_turn"), out);
  config.finish();
  return out;
}

}  // namespace rover::control
