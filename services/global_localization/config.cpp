#include "global_localization/config.hpp"

namespace rover::global {
namespace {

void add_attempts(Parameters p, ScheduleConfig& c) {
  p.add("first_interval_m", c.first_interval_m, {0.0, 1000.0}, "after the first elevation map");
  p.add("interval_m", c.interval_m, {0.5, 1000.0}, "after a fix");
  p.add("retry_interval_m", c.retry_interval_m, {0.5, 1000.0}, "after a rejection");
}

void add_height_drift(Parameters p, DriftConfig& c) {
  p.add_deg("tilt_sigma_deg", c.tilt_sigma_rad, {0.001, 5.0}, "prior of the tilt: 2 cm over 30 m");
  p.add("curvature_sigma_m", c.curvature_sigma_m, {0.0001, 1.0}, "prior of the curvature, as a height at the border");
}

void add_filter(Parameters p, PlaneConfig& c) {
  p.add("sigma_cells", c.sigma_cells, {0.5, 6.0}, "of the Gaussian window, in orbital cells; suppresses map noise");
  p.add("min_support", c.min_support, {0.05, 1.0}, "observed fraction of the window's weight");
}

void add_search(Parameters p, SearchConfig& c) {
  p.add("min_half_width_m", c.min_half_width_m, {1.0, 50.0},
        "lower bound: covariances are optimistic after long drives");
  p.add("max_half_width_m", c.max_half_width_m, {1.0, 1000.0},
        "upper bound, of a lost rover: a start pose with a large sigma_m");
  p.check(c.max_half_width_m >= c.min_half_width_m, "max_half_width_m", "must not be below min_half_width_m");
  p.add_deg("min_half_width_deg", c.min_half_width_rad, {1.0, 45.0}, "the same, yaw");
  p.add_deg("max_half_width_deg", c.max_half_width_rad, {1.0, 45.0}, "the same, yaw");
  p.check(c.max_half_width_rad >= c.min_half_width_rad, "max_half_width_deg", "must not be below min_half_width_deg");
  p.add("sigmas", c.sigmas, {1.0, 6.0}, "half width in standard deviations of the pose, within these bounds");
  p.add_deg("yaw_step_deg", c.yaw_step_rad, {0.2, 5.0}, "between two yaws of the search");
  p.add("min_overlap", c.min_overlap, {0.1, 1.0}, "fraction of the local map with orbital data");
  p.add("min_peak_distance_m", c.min_peak_distance_m, {0.5, 20.0}, "between two peaks of the correlation");
  p.add("max_peaks", c.max_peaks, {2, 50}, "to refine");
  p.add("max_cells", c.max_cells, {50, 2000}, "side of the window; a wider one is searched in blocks of cells first");
}

void add_refinement(Parameters p, RefinementConfig& c) {
  p.add("half_width_cells", c.half_width_cells, {0.5, 10.0}, "bounds around the peak");
  p.add_deg("half_width_deg", c.half_width_rad, {0.5, 15.0}, "the same, yaw");
  p.add("max_evaluations", c.max_evaluations, {20, 2000}, "of BOBYQA");
}

void add_acceptance(Parameters p, AcceptanceConfig& c) {
  p.add("min_area_m2", c.min_area_m2, {1.0, 10000.0}, "of the local map");
  p.add("max_expected_sigma_cells", c.max_expected_sigma_cells, {0.01, 100.0},
        "accuracy that relief and map noise allow; less is not featured. 95 % are within 2.45 sigma: half a cell");
  p.add_deg("max_expected_sigma_deg", c.max_expected_sigma_rad, {0.01, 10.0}, "the same, yaw");
  p.add("min_score", c.min_score, {0.0, 1.0}, "correlation of the gradients");
  p.add("max_residual_m", c.max_residual_m, {0.01, 10.0}, "rms height difference");
  p.add("max_residual_ratio", c.max_residual_ratio, {0.05, 1.0}, "ambiguity: best over second-best residual");
  p.add("max_sigma_m", c.max_sigma_m, {0.01, 10.0}, "of the match, largest principal axis");
  p.add_deg("max_sigma_deg", c.max_sigma_rad, {0.01, 10.0}, "of the match, yaw");
  p.add("max_body_sigma_m", c.max_body_sigma_m, {0.01, 10.0},
        "of the body, including map distortion: about 50 m from the matched terrain; a fix 55 m on was 1.39 m off");
  p.add("gate_chi2", c.gate_chi2, {1.0, 100.0}, "innovation gate: 99.9 % of three degrees of freedom");
}

void add_picture(Parameters p, PictureConfig& c) {
  p.add("mosaic_side_m", c.mosaic_side_m, {5.0, 200.0}, "local picture around the rover: the last 30 m driven");
  p.add("sigma_cells", c.filter.sigma_cells, {0.5, 6.0}, "of the Gaussian window of edges, in pixels of the picture");
  p.add_deg("yaw_step_deg", c.yaw_step_rad, {0.2, 5.0}, "between two yaws of the search");
  p.add("max_samples", c.max_samples, {50, 100'000}, "places of the local picture that the search compares");
  p.add("min_sigmas", c.min_sigmas, {1.0, 100.0},
        "from the second-best place's correlation to the best one's, in units of what chance gives");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  GlobalConfig& c = config.core;
  Parameters p(config_dir + "/global_localization.yaml",
               "Absolute localization on the orbital map. Accuracy with these values: test/results/correction.md.",
               list);
  p.add_s("latency_s", config.latency_us, {0.02, 10.0}, "modelled processing time, map to correction");
  p.add("max_map_age_s", config.max_map_age_s, {0.1, 60.0}, "older elevation maps are rejected");
  p.add("max_pose_age_s", config.max_pose_age_s, {0.02, 60.0}, "without a newer pose an elevation map is ignored");
  p.add("local_cell_m", config.local_cell_m, {0.02, 1.0}, "cell size of ELEVATION, as in slam.yaml");
  p.add("max_jump_m", config.max_jump_m, {0.01, 100.0},
        "position change in odom beyond the distance driven; more clears the local map");
  p.add("mosaic_side_m", c.mosaic_side_m, {5.0, 200.0}, "local map around the rover: the last 60 m driven");
  p.add("max_height_sigma_m", c.max_height_sigma_m, {0.01, 5.0}, "less certain cells of ELEVATION are ignored");
  p.add("map_noise_m", c.map_noise_m, {0.001, 10.0}, "of the orbital heights, rms");
  p.add("map_noise_cells", c.map_noise_cells, {0.1, 20.0}, "correlation length of that noise");
  p.add("map_blur_cells", c.map_blur_cells, {0.0, 3.0},
        "Gaussian blur in the orbital map; the local map gets the same");
  p.add("map_sigma_m", c.map_sigma_m, {0.0, 5.0}, "distortion of the orbital map, along each axis");
  p.add("map_sigma_length_m", c.map_sigma_length_m, {1.0, 1000.0},
        "its correlation length, where the correlation is 0.6; a third of a wave");
  add_attempts(p.section("attempts", "distance driven until the next attempt"), config.attempts);
  add_height_drift(p.section("height_drift", "of odometry over the local map, removed from the residual"),
                   c.height_drift);
  add_filter(p.section("filter", "plane fit of both maps, for heights and gradients"), c.filter);
  add_search(p.section("search", "window around the pose"), c.search);
  add_refinement(p.section("refinement", "of a peak, to less than a cell"), c.refinement);
  add_acceptance(p.section("acceptance", "limits of an accepted match"), c.acceptance);
  add_picture(p.section("picture", "orbital_picture.tif, where relief does not locate the rover"), c.picture);
  p.finish();
  return config;
}

}  // namespace rover::global
