#include "traversability/config.hpp"

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::trav {
namespace {

void read_plane(const Config& yaml, PlaneConfig& plane) {
  yaml.read("radius_m", plane.radius_m, {0.2, 3.0});
  yaml.read("min_share", plane.min_share, {0.01, 1.0});
  yaml.read("min_spread_m", plane.min_spread_m, {0.01, 1.0});
}

void read_step(const Config& yaml, StepConfig& step) {
  yaml.read("reach_m", step.reach_m, {0.05, 1.0});
  yaml.read("shown_share", step.mean_height_ratio, {0.3, 1.0});
  yaml.read("foot_m", step.region_growing_m, {0.01, 0.5});
  yaml.read("significance", step.significance, {0.0, 10.0});
  yaml.read("max_sigma_m", step.max_sigma_m, {0.005, 1.0});
}

void read_cost(const Config& yaml, CostConfig& cost) {
  yaml.read_deg("max_slope_deg", cost.max_slope_rad, {1.0, 45.0});
  yaml.read("rough_m", cost.roughness_m, {0.005, 1.0});
  yaml.read("slope_exponent", cost.slope_exponent, {0.5, 4.0});
  yaml.read("step_exponent", cost.step_exponent, {0.5, 4.0});
  yaml.read("rough_exponent", cost.roughness_exponent, {0.5, 4.0});
}

void read_ahead(const Config& yaml, AheadConfig& ahead) {
  yaml.read("near_m", ahead.near_m, {0.0, 20.0});
  yaml.read("far_m", ahead.far_m, {0.5, 20.0});
  yaml.read("half_width_m", ahead.half_width_m, {0.1, 10.0});
  yaml.read("clearance_m", ahead.clearance_m, {0.0, 5.0});
  yaml.read("min_known_share", ahead.min_known_share, {0.01, 1.0});
  if (ahead.far_m <= ahead.near_m) yaml.fail("far_m", "must be beyond near_m");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  apply_vehicle_limits(load_vehicle(config_dir), config.core);
  const Config yaml = Config::load(config_dir + "/traversability.yaml");
  double latency_s = to_seconds(config.latency_us);
  yaml.read("latency_s", latency_s, {0.02, 5.0});
  config.latency_us = to_utime(latency_s);
  yaml.read("max_map_age_s", config.max_map_age_s, {0.1, 60.0});
  yaml.read("max_pose_age_s", config.max_pose_age_s, {0.02, 60.0});
  read_plane(yaml.section("plane"), config.core.plane);
  read_step(yaml.section("step"), config.core.step);
  read_cost(yaml.section("cost"), config.core.cost);
  read_ahead(yaml.section("ahead"), config.core.ahead);
  yaml.finish();
  return config;
}

}  // namespace rover::trav
