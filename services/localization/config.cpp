#include "localization/config.hpp"

#include "common/bus/config.hpp"

namespace rover::loc {
namespace {

void read_filter(const Config& c, FilterConfig& f) {
  c.read("gyro_noise_rad_rts", f.gyro_noise_rad_rts, {1e-7, 1});
  c.read("fog_noise_rad_rts", f.fog_noise_rad_rts, {1e-7, 1});
  c.read("no_fog_noise_rad_rts", f.no_fog_noise_rad_rts, {1e-7, 1});
  c.read("gyro_bias_sigma_radps", f.gyro_bias_sigma_radps, {0, 1});
  c.read("fog_bias_sigma_radps", f.fog_bias_sigma_radps, {0, 1});
  c.read("fog_bias_walk_radps_rts", f.fog_bias_walk_radps_rts, {0, 1e-2});
  c.read("gyro_bias_walk_radps_rts", f.gyro_bias_walk_radps_rts, {0, 1});
  c.read("force_noise_mps2_rthz", f.force_noise_mps2_rthz, {1e-4, 10});
  c.read("wheel_noise_m_rtm", f.wheel_noise_m_rtm, {1e-3, 10});
  c.read("blind_rate_radps", f.no_gyro_noise_rad_rts, {1e-4, 10});
  c.read("visual_cov_factor", f.visual_cov_factor, {1, 1000});
  c.read("visual_scale_sigma", f.visual_scale_sigma, {0, 0.2});
  c.read("visual_floor_m", f.visual_floor_m, {0, 0.1});
  c.read("max_rotation_conflict_sigma", f.max_rotation_conflict_sigma, {1, 100});
  c.read_deg("max_rotation_conflict_deg", f.max_rotation_conflict_rad, {0, 180});
}

void read_slip(const Config& c, SlipConfig& s) {
  c.read("window_s", s.window_s, {0.5, 60});
  c.read("grip_window_s", s.traction_window_s, {0.4, 60});
  c.read("min_wheel_path_m", s.min_wheel_path_m, {1e-3, 10});
  c.read("min_cover", s.min_coverage, {0, 1});
  c.read("max_visual_age_s", s.max_visual_age_s, {0.1, 10});
}

void read_map(const Config& c, MapAlignmentConfig& m) {
  c.read("gate_chi2", m.gate_chi2, {0.1, 1000});
  c.read("widened_m", m.inflation_m, {0, 100});
  c.read_deg("widened_deg", m.inflation_rad, {0, 90});
  c.read("slam_rate_mps", m.slam_rate_mps, {0, 1});
  c.read_deg("slam_rate_degps", m.slam_rate_radps, {0, 90});
}

void read_status(const Config& c, LocalizationConfig& l) {
  c.read("wheel_silence_s", l.wheel_timeout_s, {0.02, 10});
  c.read("visual_degraded_s", l.visual_degraded_s, {0.1, 60});
  c.read("blind_distance_m", l.max_dead_reckoned_m, {0, 100});
  c.read("imu_lost_s", l.imu_lost_s, {0, 600});
  c.read("nothing_lost_s", l.no_odometry_lost_s, {0.1, 60});
  c.read("conflicts_until_imu_suspect", l.conflicts_until_imu_suspect, {1, 1000});
}

}  // namespace

LocalizationConfig load_config(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/localization.yaml");
  LocalizationConfig out;
  config.read("history_s", out.history_s, {5, 600});
  config.read("chain_s", out.chain_s, {0.5, 60});
  config.read("smoothing_s", out.smoothing_s, {0.01, 10});
  read_filter(config.section("filter"), out.filter);
  const Config imu = config.section("imu");
  imu.read("silence_s", out.imu.timeout_s, {0.02, 10});
  imu.read("frozen_samples", out.imu.frozen_samples, {2, 1000});
  const Config stationary = config.section("standing");
  stationary.read_deg("rate_degps", out.stationary_rate_radps, {0, 90});
  stationary.read("after_s", out.stationary_after_s, {0, 60});
  stationary.read("at_rest_after_s", out.settled_after_s, {0, 600});
  stationary.read_deg("rest_rate_degps", out.settled_rate_radps, {0, 90});
  const Config static_alignment = config.section("levelling");
  static_alignment.read("duration_s", out.static_alignment.duration_s, {0.1, 60});
  static_alignment.read("min_gravity_mps2", out.static_alignment.min_gravity_mps2, {0.1, 30});
  static_alignment.read("max_gravity_mps2", out.static_alignment.max_gravity_mps2, {0.1, 30});
  read_slip(config.section("slip"), out.slip);
  read_map(config.section("map"), out.map);
  read_status(config.section("status"), out);
  config.read("max_speed_mps", out.max_speed_mps, {0.1, 200});
  if (config.has("cameras_alone")) {
    const Config cameras = config.section("cameras_alone");
    cameras.read("enabled", out.camera_only.enabled);
    cameras.read_deg("roll_deg", out.camera_only.roll_rad, {-180, 180});
    cameras.read_deg("pitch_deg", out.camera_only.pitch_rad, {-90, 90});
  }
  if (out.chain_s > out.history_s) config.fail("chain_s", "longer than history_s");
  config.finish();
  return out;
}

}  // namespace rover::loc
