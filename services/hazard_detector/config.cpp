#include "hazard_detector/config.hpp"

#include <algorithm>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"

namespace rover::hazard {
namespace {

void read_grid(const Config& yaml, GridConfig& grid) {
  yaml.read("cell_m", grid.cell_m, {0.02, 1.0});
  yaml.read("min_x_m", grid.min_x_m, {-5.0, 5.0});
  yaml.read("max_x_m", grid.max_x_m, {0.5, 20.0});
  yaml.read("half_width_m", grid.half_width_m, {0.5, 10.0});
  if (grid.max_x_m < grid.min_x_m + grid.cell_m) yaml.fail("max_x_m", "must be beyond min_x_m");
  // The core stores cell indices in 16 bits.
  if ((grid.max_x_m - grid.min_x_m) * 2.0 * grid.half_width_m / (grid.cell_m * grid.cell_m) > 30000.0)
    yaml.fail("cell_m", "makes more than 30000 cells");
}

void read_prior(const Config& yaml, PlanePrior& prior) {
  yaml.read_deg("max_slope_deg", prior.max_slope_rad, {0.0, 30.0});
  yaml.read("max_offset_m", prior.max_offset_m, {0.0, 0.5});
  yaml.read("inlier_m", prior.inlier_m, {0.01, 0.5});
  yaml.read("tukey_m", prior.tukey_m, {0.01, 1.0});
  yaml.read("near_weight_m", prior.half_weight_m, {0.1, 100.0});
  yaml.read("min_cells", prior.min_cells, {3, 10000});
}

void read_local_ground(const Config& yaml, LocalGroundConfig& local_ground) {
  yaml.read("window_m", local_ground.window_m, {0.1, 3.0});
  yaml.read("node_m", local_ground.node_m, {0.05, 3.0});
  yaml.read("low_quantile", local_ground.low_quantile, {0.0, 0.5});
  yaml.read("high_quantile", local_ground.high_quantile, {0.5, 1.0});
  yaml.read("bound_m", local_ground.max_deviation_m, {0.0, 0.5});
  yaml.read("bound_per_m", local_ground.max_deviation_per_m, {0.0, 0.5});
  yaml.read("min_cells", local_ground.min_cells, {3, 10000});
  yaml.read("step_reach_m", local_ground.step_radius_m, {0.0, 1.0});
  yaml.read("step_slack_m", local_ground.step_tolerance_m, {0.0, 0.5});
}

void read_limits(const Config& yaml, HazardConfig& core) {
  yaml.read("near_m", core.obstacle_height_m, {0.02, 1.0});
  yaml.read("far_m", core.hole_depth_m, {0.02, 2.0});
  yaml.read("grow_m", core.grow_height_m, {0.01, 1.0});
  yaml.read("margin_m", core.margin_m, {0.0, 1.0});
  yaml.read("min_cell_samples", core.min_cell_samples, {1, 1000});
  yaml.read("min_cluster_samples", core.min_cluster_samples, {1, 10000});
}

void read_coverage(const Config& yaml, HazardConfig& core) {
  yaml.read("free_share", core.min_free_fraction, {0.1, 1.0});
  yaml.read("min_free_samples", core.min_free_samples, {1, 1000});
  yaml.read("min_coverage", core.min_coverage, {0.05, 1.0});
  yaml.read("roi_near_m", core.roi_near_m, {0.0, 10.0});
  yaml.read("roi_far_m", core.roi_far_m, {0.1, 20.0});
  if (core.roi_far_m <= core.roi_near_m) yaml.fail("roi_far_m", "must be beyond roi_near_m");
}

GroundCalibration read_calibration(const std::string& file) {
  const Config yaml = Config::load(file);
  GroundCalibration calibration;
  calibration.height_m = yaml.number("height_m", {0.1, 5.0});
  calibration.pitch_rad = to_rad(yaml.number("pitch_deg", {5.0, 85.0}));
  calibration.roll_rad = to_rad(yaml.number("roll_deg", {-45.0, 45.0}));
  yaml.finish();
  return calibration;
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  const Vehicle vehicle = load_vehicle(config_dir);
  config.core.origin_height_m = vehicle.origin_height_m;
  config.core.obstacle_height_m = vehicle.hazard_height_m;
  config.core.prior.front_axle_x_m = *std::max_element(vehicle.wheel_x_m.begin(), vehicle.wheel_x_m.end());
  const Config yaml = Config::load(config_dir + "/hazard_detector.yaml");
  double latency_s = to_seconds(config.latency_us);
  yaml.read("latency_s", latency_s, {0.02, 5.0});
  config.latency_us = to_utime(latency_s);
  read_grid(yaml.section("grid"), config.core.grid);
  read_prior(yaml.section("plane"), config.core.prior);
  read_local_ground(yaml.section("relief"), config.core.local_ground);
  read_limits(yaml.section("limits"), config.core);
  read_coverage(yaml.section("coverage"), config.core);
  yaml.finish();
  const std::string calibration = config_dir + "/" + kCalibrationFile;
  if (std::filesystem::exists(calibration)) config.core.calibration = read_calibration(calibration);
  return config;
}

}  // namespace rover::hazard
