#include "locomotion/config.hpp"

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::locomotion {
namespace {

void read_lease(const Config& c, LocomotionConfig& out) {
  c.read("lease_max_age_s", out.lease_max_age_s, {0.02, 0.2});
  c.read("wheel_state_max_age_s", out.wheel_state_max_age_s, {0.02, 1.0});
}

void read_ramps(const Config& c, LocomotionConfig& out) {
  c.read("acceleration_mps2", out.acceleration_mps2, {0.01, 2.0});
  c.read("emergency_deceleration_mps2", out.emergency_deceleration_mps2, {0.1, 5.0});
  c.read_deg("max_turn_rate_degps", out.max_turn_rate_radps, {0.5, 60.0});
}

void read_steering(const Config& c, LocomotionConfig& out) {
  c.read("rate_share", out.steering_rate_share, {0.1, 1.0});
  c.read_deg("aligned_deg", out.alignment_tolerance_rad, {0.1, 20.0});
  c.read_deg("slow_from_deg", out.steering_slow_rad, {0.1, 30.0});
  c.read_deg("stop_from_deg", out.steering_stop_rad, {0.2, 45.0});
  c.read_deg("hold_slack_deg", out.hold_tolerance_rad, {0.1, 20.0});
  c.read("hold_patience_s", out.hold_delay_s, {0.1, 20.0});
  c.read("slow_from_curvature_per_m", out.curvature_slow_per_m, {0.01, 2.0});
  c.read("stop_from_curvature_per_m", out.curvature_stop_per_m, {0.02, 4.0});
  if (out.steering_stop_rad <= out.steering_slow_rad) c.fail("stop_from_deg", "must be larger than slow_from_deg");
  if (out.curvature_stop_per_m <= out.curvature_slow_per_m)
    c.fail("stop_from_curvature_per_m", "must be larger than slow_from_curvature_per_m");
}

void read_stall(const Config& c, StallRecoveryConfig& out) {
  c.read("patience_s", out.wait_s, {0.2, 20.0});
  c.read_deg("most_mean_error_deg", out.max_mean_error_rad, {0.0, 45.0});
  c.read("speed_mps", out.speed_mps, {0.005, 0.1});
  c.read("way_m", out.max_distance_m, {0.0, 1.0});
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig out;
  out.vehicle = load_vehicle(config_dir);
  out.locomotion.acceleration_mps2 = out.vehicle.deceleration_mps2;
  out.locomotion.max_curvature_per_m = 1.0 / out.vehicle.min_turn_radius_m;
  const Config config = Config::load(config_dir + "/locomotion.yaml");
  config.read("command_validity_s", out.command_validity_s, {0.04, 0.5});
  read_lease(config.section("lease"), out.locomotion);
  read_ramps(config.section("ramps"), out.locomotion);
  read_steering(config.section("steering"), out.locomotion);
  read_stall(config.section("stall"), out.locomotion.stall);
  config.finish();
  return out;
}

}  // namespace rover::locomotion
