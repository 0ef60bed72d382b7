#include "slam/config.hpp"

#include "common/bus/config.hpp"

namespace rover::slam {
namespace {

void read_map(const Config& c, ElevationConfig& m) {
  c.read("cells", m.cells, {20, 400});
  c.read("cell_m", m.patches.cell_m, {0.02, 1.0});
  c.read("reach_m", m.patches.reach_m, {1.0, 50.0});
  c.read("step_m", m.patches.step_m, {0.01, 1.0});
  c.read("correlated_points", m.patches.correlated_points, {1.0, 1000.0});
  c.read("roughness_m", m.patches.roughness_m, {0.0, 0.1});
  c.read("gate_sigma", m.gate_sigma, {1.0, 10.0});
  c.read("min_sigma_m", m.min_sigma_m, {0.0001, 0.1});
  c.read("growth_m2_per_m", m.growth_m2_per_m, {0.0, 0.01});
  c.read("see_through_margin_m", m.clearing_margin_m, {0.01, 1.0});
  c.read("see_through_rays", m.clearing_rays, {1, 255});
  c.read("contact_m", m.ray_end_margin_m, {0.0, 2.0});
}

void read_match(const Config& c, MatchConfig& m) {
  c.read("max_patches", m.max_patches, {100, 100000});
  c.read("max_range_m", m.max_range_m, {1.0, 50.0});
  c.read("min_patches", m.min_patches, {20, 10000});
  c.read("model_sigma_m", m.model_sigma_m, {0.0, 0.1});
  c.read("blur_m", m.horizontal_sigma_m, {0.0, 0.2});
  c.read("kernel_sigma", m.kernel_sigma, {1.0, 10.0});
  c.read("temper", m.temper, {0.001, 10.0});
  c.read("height_sigma_m", m.height_sigma_m, {0.0001, 1.0});
  c.read_deg("tilt_sigma_deg", m.tilt_sigma_rad, {0.001, 5.0});
  c.read("blind_sigma_m", m.unobservable_sigma_m, {0.001, 10.0});
  c.read("probe_m", m.hessian_step_m, {0.005, 1.0});
  c.read("lever_m", m.yaw_lever_m, {0.1, 20.0});
}

void read_filter(const Config& c, FilterConfig& f) {
  c.read("min_particles", f.min_particles, {10, 10000});
  c.read("max_particles", f.max_particles, {10, 10000});
  if (f.max_particles < f.min_particles) c.fail("max_particles", "must not be below min_particles");
  c.read("resample_share", f.resample_share, {0.0, 1.0});
  c.read("bin_m", f.bin_m, {0.001, 1.0});
  c.read_deg("bin_deg", f.bin_rad, {0.001, 10.0});
  c.read("kld_error", f.kld_error, {0.001, 1.0});
}

void read_motion(const Config& c, MotionConfig& m) {
  c.read("along_share", m.along_share, {0.0, 1.0});
  c.read("scale_share", m.scale_error_share, {0.0, 1.0});
  c.read("blind_share", m.dead_reckoned_share, {0.0, 1.0});
  c.read("across_share", m.across_share, {0.0, 1.0});
  c.read_deg("yaw_deg_per_m", m.yaw_rad_per_m, {0.0, 10.0});
  c.read("yaw_share", m.yaw_share, {0.0, 1.0});
  c.read_deg("slow_yaw_deg_rts", m.gyro_bias_rad_per_sqrt_s, {0.0, 1.0});
  c.read("still_m", m.min_noise_m, {0.0, 0.1});
}

void read_attitude(const Config& c, AttitudeNoise& a) {
  c.read_deg("tilt_deg", a.tilt_rad, {0.0, 5.0});
  c.read("height_m", a.height_m, {0.0001, 0.1});
}

void read_jump(const Config& c, JumpConfig& j) {
  c.read("top_speed_mps", j.max_speed_mps, {0.01, 10.0});
  c.read("slack_m", j.slack_m, {0.0, 5.0});
  c.read_deg("top_rate_degps", j.max_rate_radps, {0.1, 360.0});
  c.read_deg("slack_deg", j.slack_rad, {0.0, 90.0});
}

void read_drift(const Config& c, DriftConfig& d) {
  c.read("position_share", d.position_share, {0.0, 0.1});
  c.read_deg("yaw_deg_per_sqrt_m", d.yaw_rad_per_sqrt_m, {0.0, 5.0});
}

void read_anchor(const Config& c, AnchorConfig& a) {
  c.read("slow_mps", a.slew_mps, {0.0, 1.0});
  c.read_deg("slow_degps", a.slew_radps, {0.0, 90.0});
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  SlamConfig& core = config.core;
  const Config yaml = Config::load(config_dir + "/slam.yaml");
  double latency_s = to_seconds(config.latency_us);
  yaml.read("latency_s", latency_s, {0.02, 5.0});
  config.latency_us = to_utime(latency_s);
  core.seed = static_cast<std::uint64_t>(yaml.integer64("seed", {0, 1e15}));
  yaml.read("min_fitting_share", core.min_inlier_share, {0.0, 1.0});
  yaml.read("lost_clouds", core.lost_clouds, {1, 100});
  read_map(yaml.section("map"), core.map);
  read_match(yaml.section("match"), core.match);
  read_filter(yaml.section("filter"), core.filter);
  read_motion(yaml.section("motion"), core.motion);
  read_attitude(yaml.section("attitude"), core.attitude);
  read_jump(yaml.section("jump"), core.jump);
  read_drift(yaml.section("drift"), core.drift);
  read_anchor(yaml.section("anchor"), core.anchor);
  yaml.finish();
  return config;
}

}  // namespace rover::slam
