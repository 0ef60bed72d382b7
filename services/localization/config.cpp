#include "localization/config.hpp"

#include "common/bus/navigation_config.hpp"

namespace rover::loc {
namespace {

void add_filter(Parameters p, FilterConfig& c) {
  p.add("gyro_noise_rad_rts", c.gyro_noise_rad_rts, {1e-7, 1}, "angle random walk; STIM300: 0.15 deg/√h = 4.4e-5");
  p.add("fog_noise_rad_rts", c.fog_noise_rad_rts, {1e-7, 1},
        "fibre-optic gyro (z); KVH DSP-1760: 0.012 deg/√h = 3.5e-6, plus misalignment of the mounting");
  p.add("no_fog_noise_rad_rts", c.no_fog_noise_rad_rts, {1e-7, 1},
        "z without the fibre-optic gyro: MEMS gyro of unknown bias");
  p.add("gyro_bias_sigma_radps", c.gyro_bias_sigma_radps, {0, 1}, "after static alignment");
  p.add("fog_bias_sigma_radps", c.fog_bias_sigma_radps, {0, 1}, "after static alignment");
  p.add("gyro_bias_walk_radps_rts", c.gyro_bias_walk_radps_rts, {0, 1}, "STIM300: 0.3 deg/h over 600 s");
  p.add("fog_bias_walk_radps_rts", c.fog_bias_walk_radps_rts, {0, 1e-2}, "KVH DSP-1760: 0.05 deg/h = 1.4e-8");
  p.add("force_noise_mps2_rthz", c.force_noise_mps2_rthz, {1e-4, 10},
        "accelerations of the drive, including bumps, averaged over 1 s");
  p.add("wheel_noise_m_rtm", c.wheel_noise_m_rtm, {1e-3, 10},
        "random error of wheel odometry, standard deviation after 1 m");
  p.add("slip_sigma", c.slip_sigma, {0, 1}, "of the slip since the newest visual motion: an error per metre");
  p.add("no_gyro_noise_rad_rts", c.no_gyro_noise_rad_rts, {1e-4, 10}, "attitude without gyro, from wheels alone");
  p.add("visual_scale_sigma", c.visual_scale_sigma, {0, 0.2}, "residual of a calibration error of 0.2 px");
  p.add_deg("visual_mounting_sigma_deg", c.mounting_sigma_rad, {0, 10},
            "rotation of the camera on the body, each axis: what docs/calibration.md leaves");
  p.add("visual_floor_m", c.visual_floor_m, {0, 0.1}, "noise floor of a visual motion, standard deviation");
  p.add("max_rotation_conflict_sigma", c.max_rotation_conflict_sigma, {1, 100},
        "innovation gate between gyro and images");
  p.add_deg("max_rotation_conflict_deg", c.max_rotation_conflict_rad, {0, 180},
            "smaller differences always pass the gate");
}

void add_imu(Parameters p, ImuMonitorConfig& c) {
  p.add("timeout_s", c.timeout_s, {0.02, 10}, "without a valid sample");
  p.add("frozen_samples", c.frozen_samples, {2, 1000}, "identical samples in a row");
}

void add_stationary(Parameters p, StationaryConfig& c) {
  p.add_deg("rate_degps", c.rate_radps, {0, 90}, "stationary: body rate below this and wheels still");
  p.add("after_s", c.after_s, {0, 60}, "for this long");
  p.add("settled_after_s", c.settled_after_s, {0, 600}, "the body has stopped rocking: the gyros measure their bias");
  p.add_deg("settled_rate_degps", c.settled_rate_radps, {0, 90},
            "the body rotates before its wheels move measurably; 7 sigma of the fibre-optic gyro over a tick");
}

void add_static_alignment(Parameters p, StaticAlignmentConfig& c) {
  p.add("duration_s", c.duration_s, {0.1, 60},
        "of standstill; also sets how well the gyro bias, and later the heading, is known");
  p.add("min_gravity_mps2", c.min_gravity_mps2, {0.1, 30}, "accepted magnitude of gravity: Mars 3.7, Earth 9.8");
  p.add("max_gravity_mps2", c.max_gravity_mps2, {0.1, 30}, "the same, upper bound");
}

void add_slip(Parameters p, SlipConfig& c) {
  p.add("window_s", c.window_s, {0.5, 60}, "sliding window of SLIP (HDPR)");
  p.add("traction_window_s", c.traction_window_s, {0.4, 60}, "the same, for dead reckoning between two visual motions");
  p.add("min_wheel_path_m", c.min_wheel_path_m, {1e-3, 10}, "less wheel travel in the window gives no slip ratio");
  p.add("min_coverage", c.min_coverage, {0, 1}, "fraction of the wheel travel that visual odometry must cover");
  p.add("max_visual_age_s", c.max_visual_age_s, {0.1, 10},
        "the window ends at the newest visual motion, at most this long ago");
}

void add_map(Parameters p, MapAlignmentConfig& c) {
  p.add("gate_chi2", c.gate_chi2, {0.1, 1000}, "99.9 % of chi-square with three degrees of freedom");
  p.add("inflation_m", c.inflation_m, {0, 100},
        "added to the pose's sigma if a correction fails the gate: a third of the smallest search window of "
        "global_localization");
  p.add_deg("inflation_deg", c.inflation_rad, {0, 90}, "the same, yaw");
  p.add("slam_sigma_m", c.slam_sigma_m, {0.0001, 1}, "error of SLAM's motion of map against odom, cloud to cloud");
  p.add_deg("slam_sigma_deg", c.slam_sigma_rad, {0.0001, 10}, "the same, yaw");
  p.add("slam_rate_mps", c.slam_rate_mps, {0, 1}, "limit of the motion of map against odom by SLAM");
  p.add_deg("slam_rate_degps", c.slam_rate_radps, {0, 90}, "the same, yaw");
}

void add_status(Parameters p, StatusConfig& c) {
  p.add("wheel_timeout_s", c.wheel_timeout_s, {0.02, 10}, "without wheel encoders: DEGRADED");
  p.add("visual_degraded_s", c.visual_degraded_s, {0.1, 60}, "without visual odometry: DEGRADED");
  p.add("max_dead_reckoned_m", c.max_dead_reckoned_m, {0, 100},
        "distance without visual odometry and SLAM; more: LOST");
  p.add("imu_lost_s", c.imu_lost_s, {0, 600}, "without IMU: LOST");
  p.add("no_odometry_lost_s", c.no_odometry_lost_s, {0.1, 60}, "without wheels and visual odometry: LOST");
  p.add(
      "conflicts_until_gyro_suspect", c.conflicts_until_gyro_suspect, {1, 1000},
      "visual motions that contradict the gyro, without one as long that agrees; it is no longer used then: DEGRADED");
}

void add_camera_only(Parameters p, CameraOnlyConfig& c) {
  p.add("enabled", c.enabled, "never on a rover");
  p.add_deg("roll_deg", c.roll_rad, {-180, 180}, "initial attitude: no accelerometer measures gravity");
  p.add_deg("pitch_deg", c.pitch_rad, {-90, 90}, "the same");
}

}  // namespace

LocalizationConfig load_config(const std::string& config_dir, ParameterList* list) {
  LocalizationConfig c;
  Parameters p(config_dir + "/localization.yaml",
               "Localization. Noise parameters: STIM300 class IMU and a fibre-optic gyro, conservative; the others are "
               "estimates.",
               list);
  p.add("history_s", c.history_s, {5, 600}, "maximum age of a visual motion");
  p.add("chain_s", c.chain_s, {0.5, 60}, "longest sequence of visual motions of one keyframe fused as one measurement");
  p.check(c.chain_s <= c.history_s, "chain_s", "longer than history_s");
  p.add("smoothing_s", c.smoothing_s, {0.01, 10}, "time constant with which the pose absorbs late updates");
  p.add("max_speed_mps", c.max_speed_mps, {0.1, 200}, "faster visual motions are rejected");
  add_filter(p.section("filter", "error-state Kalman filter"), c.filter);
  add_imu(p.section("imu", "limits beyond which the IMU is unhealthy"), c.imu);
  add_stationary(p.section("stationary", "standstill: the attitude is held"), c.stationary);
  add_static_alignment(p.section("static_alignment", "attitude and gyro bias at the start"), c.static_alignment);
  add_slip(p.section("slip", "wheel slip and traction"), c.slip);
  add_map(p.section("map", "odom on the orbital map"), c.map);
  add_status(p.section("status", "of POSE"), c.status);
  add_camera_only(p.section("camera_only", "for recordings without IMU and wheels"), c.camera_only);
  p.finish();
  const double cpu_scale = load_navigation(config_dir).cpu_scale;
  c.slip.max_visual_age_s *= cpu_scale;
  c.status.visual_degraded_s *= cpu_scale;
  return c;
}

}  // namespace rover::loc
