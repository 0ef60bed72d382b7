#include "locomotion/config.hpp"

#include "common/bus/vehicle_config.hpp"

namespace rover::locomotion {
namespace {

void add_steering(Parameters& p, LocomotionConfig& c) {
  p.add("steering_rate_ratio", c.steering_rate_ratio, {0.1, 1.0},
        "of the motor rate, used while rolling; the rest is margin for tracking");
  p.add_deg("alignment_tolerance_deg", c.alignment_tolerance_rad, {0.1, 20.0},
            "largest steering error at which motion may start");
  p.add_deg("steering_slow_deg", c.steering_slow_rad, {0.1, 30.0}, "steering error from which the speed is reduced");
  p.add_deg("steering_stop_deg", c.steering_stop_rad, {0.2, 45.0}, "steering error at which the speed is zero");
  p.check(c.steering_stop_rad > c.steering_slow_rad, "steering_stop_deg", "must be larger than steering_slow_deg");
  p.add_deg("hold_tolerance_deg", c.hold_tolerance_rad, {0.1, 20.0},
            "deflection of a held wheel that, after hold_delay_s, resets the held angle to the measured one");
  p.add("hold_delay_s", c.hold_delay_s, {0.1, 20.0}, "see hold_tolerance_deg");
  p.add("curvature_slow_per_m", c.curvature_slow_per_m, {0.01, 2.0}, "curvature error from which the speed is reduced");
  p.add("curvature_stop_per_m", c.curvature_stop_per_m, {0.02, 4.0}, "curvature error at which the speed is zero");
  p.check(c.curvature_stop_per_m > c.curvature_slow_per_m, "curvature_stop_per_m",
          "must be larger than curvature_slow_per_m");
}

void add_stall(Parameters p, StallRecoveryConfig& c) {
  p.add("wait_s", c.wait_s, {0.2, 20.0}, "setpoints reached, wheels not; an unobstructed wheel lags by 0.1 s");
  p.add_deg("max_mean_error_deg", c.max_mean_error_rad, {0.0, 45.0},
            "mean of the four steered wheels; no recovery beyond it, because the wheels would scrub");
  p.add("speed_mps", c.speed_mps, {0.005, 0.1}, "while the blocked wheel is freed");
  p.add("max_distance_m", c.max_distance_m, {0.0, 1.0}, "gives up after it; more than the wheel radius of 0.125 m");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig out;
  LocomotionConfig& c = out.locomotion;
  out.vehicle = load_vehicle(config_dir);
  c.acceleration_mps2 = out.vehicle.deceleration_mps2;
  c.max_curvature_per_m = 1.0 / out.vehicle.min_turn_radius_m;
  Parameters p(config_dir + "/locomotion.yaml",
               "Wheel controller. Geometry, motor limits and acceleration come from vehicle.yaml.", list);
  p.add("command_validity_s", out.command_validity_s, {0.04, 0.5},
        "of WHEEL_COMMAND; the driver stops the wheels when it expires");
  p.add("lease_max_age_s", c.lease_max_age_s, {0.02, 0.2}, "of DRIVE_PERMIT and MOTION_COMMAND");
  p.add("wheel_state_max_age_s", c.wheel_state_max_age_s, {0.02, 1.0}, "of WHEEL_STATE; older: no motion");
  p.add("emergency_deceleration_mps2", c.emergency_deceleration_mps2, {0.1, 5.0},
        "without a lease: from 0.2 m/s to rest in 0.5 s and 0.05 m");
  p.add_deg("max_turn_rate_degps", c.max_turn_rate_radps, {0.5, 60.0}, "of a point turn");
  add_steering(p, c);
  add_stall(p.section("stall", "stall recovery: roll slowly to free a wheel that a rock blocks from steering"),
            c.stall);
  p.finish();
  return out;
}

}  // namespace rover::locomotion
