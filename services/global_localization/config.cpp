#include "global_localization/config.hpp"

#include "common/bus/config.hpp"

namespace rover::global {
namespace {

void read_drift(const Config& yaml, DriftConfig& out) {
  yaml.read_deg("tilt_sigma_deg", out.tilt_sigma_rad, {0.001, 5.0});
  yaml.read("bow_sigma_m", out.curvature_sigma_m, {0.0001, 1.0});
}

void read_schedule(const Config& yaml, ScheduleConfig& schedule) {
  yaml.read("first_m", schedule.first_m, {0.0, 1000.0});
  yaml.read("every_m", schedule.every_m, {0.5, 1000.0});
  yaml.read("retry_m", schedule.retry_m, {0.5, 1000.0});
}

void read_filter(const Config& yaml, PlaneConfig& filter) {
  yaml.read("sigma_cells", filter.sigma_cells, {0.5, 6.0});
  yaml.read("min_support", filter.min_support, {0.05, 1.0});
}

void read_search(const Config& yaml, SearchConfig& search) {
  yaml.read("min_reach_m", search.min_reach_m, {1.0, 50.0});
  yaml.read("max_reach_m", search.max_reach_m, {1.0, 50.0});
  yaml.read_deg("min_reach_deg", search.min_reach_rad, {1.0, 45.0});
  yaml.read_deg("max_reach_deg", search.max_reach_rad, {1.0, 45.0});
  yaml.read("sigmas", search.sigmas, {1.0, 6.0});
  yaml.read_deg("yaw_step_deg", search.yaw_step_rad, {0.2, 5.0});
  yaml.read("min_overlap", search.min_overlap, {0.1, 1.0});
  yaml.read("apart_m", search.apart_m, {0.5, 20.0});
  yaml.read("peaks", search.peaks, {2, 50});
  if (search.max_reach_m < search.min_reach_m) yaml.fail("max_reach_m", "must not be below min_reach_m");
  if (search.max_reach_rad < search.min_reach_rad) yaml.fail("max_reach_deg", "must not be below min_reach_deg");
}

void read_refinement(const Config& yaml, RefinementConfig& refinement) {
  yaml.read("reach_cells", refinement.reach_cells, {0.5, 10.0});
  yaml.read_deg("reach_deg", refinement.reach_rad, {0.5, 15.0});
  yaml.read("most_evaluations", refinement.most_evaluations, {20, 2000});
}

void read_acceptance(const Config& yaml, AcceptanceConfig& acceptance) {
  yaml.read("min_area_m2", acceptance.min_area_m2, {1.0, 10000.0});
  yaml.read("max_expected_sigma_cells", acceptance.max_expected_sigma_cells, {0.01, 100.0});
  yaml.read_deg("max_expected_sigma_deg", acceptance.max_expected_sigma_rad, {0.01, 10.0});
  yaml.read("min_score", acceptance.min_score, {0.0, 1.0});
  yaml.read("max_residual_m", acceptance.max_residual_m, {0.01, 10.0});
  yaml.read("max_residual_ratio", acceptance.max_residual_ratio, {0.05, 1.0});
  yaml.read("max_sigma_m", acceptance.max_sigma_m, {0.01, 10.0});
  yaml.read_deg("max_sigma_deg", acceptance.max_sigma_rad, {0.01, 10.0});
  yaml.read("max_body_sigma_m", acceptance.max_body_sigma_m, {0.01, 10.0});
  yaml.read("gate_chi2", acceptance.gate_chi2, {1.0, 100.0});
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  const Config yaml = Config::load(config_dir + "/global_localization.yaml");
  double latency_s = to_seconds(config.latency_us);
  yaml.read("latency_s", latency_s, {0.02, 10.0});
  config.latency_us = to_utime(latency_s);
  yaml.read("max_map_age_s", config.max_map_age_s, {0.1, 60.0});
  yaml.read("max_pose_age_s", config.max_pose_age_s, {0.02, 60.0});
  yaml.read("local_cell_m", config.local_cell_m, {0.02, 1.0});
  yaml.read("max_jump_m", config.max_jump_m, {0.01, 100.0});
  yaml.read("memory_side_m", config.core.mosaic_side_m, {5.0, 200.0});
  yaml.read("max_height_sigma_m", config.core.max_height_sigma_m, {0.01, 5.0});
  yaml.read("map_noise_m", config.core.map_noise_m, {0.001, 10.0});
  yaml.read("map_noise_cells", config.core.map_noise_cells, {0.1, 20.0});
  read_drift(yaml.section("bend"), config.core.drift);
  yaml.read("map_blur_cells", config.core.map_blur_cells, {0.0, 3.0});
  yaml.read("map_sigma_m", config.core.map_sigma_m, {0.0, 5.0});
  yaml.read_deg("map_sigma_deg", config.core.map_sigma_rad, {0.0, 5.0});
  read_schedule(yaml.section("tries"), config.schedule);
  read_filter(yaml.section("filter"), config.core.filter);
  read_search(yaml.section("search"), config.core.search);
  read_refinement(yaml.section("refinement"), config.core.refinement);
  read_acceptance(yaml.section("acceptance"), config.core.acceptance);
  yaml.finish();
  return config;
}

}  // namespace rover::global
