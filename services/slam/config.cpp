#include "slam/config.hpp"

namespace rover::slam {
namespace {

void add_map(Parameters p, ElevationConfig& c) {
  p.add("cells", c.cells, {20, 400}, "per side: 20 x 20 m at 0.1 m (GA SLAM)");
  p.add("cell_m", c.patches.cell_m, {0.02, 1.0}, "side of a cell");
  p.add("max_range_m", c.patches.max_range_m, {1.0, 50.0}, "farther points are ignored");
  p.add("step_m", c.patches.step_m, {0.01, 1.0}, "spread of heights in a cell that makes it a step");
  p.add("correlated_points", c.patches.correlated_points, {1.0, 1000.0},
        "neighbouring points that share a stereo error");
  p.add("roughness_m", c.patches.roughness_m, {0.0, 0.1}, "standard deviation of the ground within a cell");
  p.add("gate_sigma", c.gate_sigma, {1.0, 10.0}, "innovation gate: beyond it a height is an outlier");
  p.add("min_sigma_m", c.min_sigma_m, {0.0001, 0.1}, "lower bound: common errors of all clouds do not average out");
  p.add("growth_m2_per_m", c.growth_m2_per_m, {0.0, 0.01}, "process noise since a cell was seen: 2 cm over 10 m");
  p.add("clearing_margin_m", c.clearing_margin_m, {0.01, 1.0},
        "a ray this far and 2 sigma below a height passes through");
  p.add("clearing_rays", c.clearing_rays, {1, 255}, "rays through a cell that clear it");
  p.add("ray_end_margin_m", c.ray_end_margin_m, {0.0, 2.0},
        "no clearing in the last part of a ray, which touches ground");
}

void add_match(Parameters p, MatchConfig& c) {
  p.add("max_patches", c.max_patches, {100, 100000}, "subsampled evenly beyond it");
  p.add("max_range_m", c.max_range_m, {1.0, 50.0}, "beyond, depth noise biases the match more than odometry drifts");
  p.add("min_patches", c.min_patches, {20, 10000}, "patches on the map; fewer: no match");
  p.add("model_sigma_m", c.model_sigma_m, {0.0, 0.1}, "unmodelled height error");
  p.add("horizontal_sigma_m", c.horizontal_sigma_m, {0.0, 0.2}, "of the grid; times the slope: a height error");
  p.add("kernel_sigma", c.kernel_sigma, {1.0, 10.0}, "scale of the Geman-McClure kernel");
  p.add("temper", c.temper, {0.001, 10.0}, "factor on the log-likelihood: patch errors are correlated");
  p.add("height_sigma_m", c.height_sigma_m, {0.0001, 1.0}, "prior of the fitted plane");
  p.add_deg("tilt_sigma_deg", c.tilt_sigma_rad, {0.001, 5.0}, "prior of the fitted plane");
  p.add("hessian_step_m", c.hessian_step_m, {0.005, 1.0}, "step of the numerical Hessian");
  p.add("unobservable_sigma_m", c.unobservable_sigma_m, {0.001, 10.0},
        "unobservable above: rough ground has 7 to 11 mm, noise on a plane 15 mm and more");
  p.add("yaw_lever_m", c.yaw_lever_m, {0.1, 20.0}, "scales yaw to metres, to compare it with x and y");
}

void add_match_error(Parameters p, MatchErrorConfig& c) {
  p.add("bias_sigma_m", c.bias_sigma_m, {0.0, 1.0}, "constant error along x or y, before the first match");
  p.add("bias_m_rtm", c.bias_m_rtm, {0.0, 1.0}, "its random walk, standard deviation after 1 m");
  p.add("scatter_matches", c.scatter_matches, {1.0, 1e6}, "number of matches that the scatter is averaged over");
}

void add_filter(Parameters p, FilterConfig& c) {
  p.add("min_particles", c.min_particles, {10, 10000}, "GA SLAM: 100 to 200");
  p.add("max_particles", c.max_particles, {10, 10000}, "upper bound of KLD sampling");
  p.check(c.max_particles >= c.min_particles, "max_particles", "must not be below min_particles");
  p.add("resample_ratio", c.resample_ratio, {0.0, 1.0}, "effective sample size below which the filter resamples");
  p.add("bin_m", c.bin_m, {0.001, 1.0}, "histogram bins of KLD sampling");
  p.add_deg("bin_deg", c.bin_rad, {0.001, 10.0}, "the same, yaw");
  p.add("kld_error", c.kld_error, {0.001, 1.0}, "KLD bound, with 99 % probability");
}

void add_motion(Parameters p, MotionConfig& c) {
  p.add("along_sigma_per_m", c.along_sigma_per_m, {0.0, 1.0},
        "visual odometry: 1 % of the 8 cm between two frames, random");
  p.add("across_sigma_per_m", c.across_sigma_per_m, {0.0, 1.0}, "the same, to the side");
  p.add("scale_error_per_m", c.scale_error_per_m, {0.0, 1.0}, "growth of POSE's sigma that is scale error, not noise");
  p.add("dead_reckoned_sigma_per_m", c.dead_reckoned_sigma_per_m, {0.0, 1.0},
        "both axes, on wheel odometry alone (slip)");
  p.add_deg("yaw_deg_per_m", c.yaw_rad_per_m, {0.0, 10.0},
            "fibre-optic gyro with bias; matching drifts by 0.5 deg in 100 m");
  p.add("yaw_sigma_ratio", c.yaw_sigma_ratio, {0.0, 1.0},
        "of the turn; POSE's covariance adds more if the gyro is lost");
  p.add_deg("gyro_bias_deg_per_sqrt_s", c.gyro_bias_rad_per_sqrt_s, {0.0, 1.0},
            "growth of POSE's yaw sigma that is gyro bias, not noise; without gyro 0.017");
  p.add("min_noise_m", c.min_noise_m, {0.0, 0.1}, "lower bound per cloud");
}

void add_attitude(Parameters p, AttitudeNoise& c) {
  p.add_deg("tilt_deg", c.tilt_rad, {0.0, 5.0}, "roll and pitch, cloud to cloud");
  p.add("height_m", c.height_m, {0.0001, 0.1}, "body origin, cloud to cloud");
}

void add_jump(Parameters p, JumpConfig& c) {
  p.add("max_speed_mps", c.max_speed_mps, {0.01, 10.0}, "top speed is 0.2 m/s");
  p.add("tolerance_m", c.tolerance_m, {0.0, 5.0}, "added to the distance");
  p.add_deg("max_rate_degps", c.max_rate_radps, {0.1, 360.0}, "turn rate");
  p.add_deg("tolerance_deg", c.tolerance_rad, {0.0, 90.0}, "added to the turn");
}

void add_drift(Parameters p, DriftConfig& c) {
  p.add("position_sigma_per_m", c.position_sigma_per_m, {0.0, 0.1}, "proportional to the distance");
  p.add_deg("yaw_deg_per_sqrt_m", c.yaw_rad_per_sqrt_m, {0.0, 5.0}, "random walk");
}

void add_anchor(Parameters p, AnchorConfig& c) {
  p.add("slew_mps", c.slew_mps, {0.0, 1.0}, "above localization's slew limit for SLAM, 0.02 m/s");
  p.add_deg("slew_degps", c.slew_radps, {0.0, 90.0}, "the same, 0.3 deg/s");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  SlamConfig& c = config.core;
  Parameters p(
      config_dir + "/slam.yaml",
      "Elevation map and particle filter SLAM (Geromichalos et al. 2020, Azkarate et al. 2020). Values without a "
      "source: slam_study (test/results/slam.md).",
      list);
  p.add_s("latency_s", config.latency_us, {0.02, 5.0}, "modelled processing time, cloud to map");
  p.add("seed", c.seed, {0, 1e15}, "of the random numbers");
  p.add("min_inlier_ratio", c.min_inlier_ratio, {0.0, 1.0}, "of the matched patches; less: LOST");
  p.add("lost_clouds", c.lost_clouds, {1, 100}, "in a row: the map restarts");
  add_map(p.section("map", "elevation map"), c.map);
  add_match(p.section("match", "a cloud with the map"), c.match);
  add_match_error(p.section("match_error", "estimated while visual odometry has no gaps"), c.match_error);
  add_filter(p.section("filter", "particle filter"), c.filter);
  add_motion(p.section("motion", "noise of the prediction, standard deviations"), c.motion);
  add_attitude(p.section("attitude", "errors of odometry's attitude and height"), c.attitude);
  add_jump(p.section("jump", "faster odometry has jumped"), c.jump);
  add_drift(p.section("drift", "growth of SLAM_POSE's sigma since the start or the newest correction"), c.drift);
  add_anchor(p.section("anchor", "faster changes of map -> odom are external corrections"), c.anchor);
  p.finish();
  return config;
}

}  // namespace rover::slam
