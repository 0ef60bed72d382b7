#include "point_cloud/config.hpp"

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/stereo/matcher_config.hpp"

namespace rover::cloud {
namespace {

void read_filter(const Config& yaml, FilterConfig& filter) {
  yaml.read("voxel_m", filter.voxel_m, {0.02, 0.5});
  yaml.read("outlier_radius_m", filter.outlier_radius_m, {0.02, 2.0});
  yaml.read("outlier_neighbours", filter.outlier_neighbours, {1, 100});
  yaml.read("max_points", filter.max_points, {100, 25000});  // CLOUD stays below 0.5 MB
}

void read_fattening(const Config& yaml, FatteningConfig& fattening) {
  yaml.read("jump_px", fattening.min_jump_px, {0.1, 50.0});
  yaml.read("steep_px_per_px", fattening.slope_px_per_px, {0.0, 5.0});
  yaml.read("width_px", fattening.width_px, {0, 50});
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  config.rig = load_stereo_rig(config_dir, "navcam");
  const Vehicle vehicle = load_vehicle(config_dir);
  if (!vehicle.pan_tilt) throw ConfigError(config_dir + "/vehicle.yaml: pan_tilt: missing, the NavCam stands on it");
  config.unit = *vehicle.pan_tilt;
  config.ground_below_m = vehicle.origin_height_m;
  const Config yaml = Config::load(config_dir + "/point_cloud.yaml");
  double latency_s = to_seconds(config.latency_us);
  yaml.read("latency_s", latency_s, {0.02, 5.0});
  config.latency_us = to_utime(latency_s);
  PointCloudConfig& core = config.core;
  yaml.read_deg("tilt_step_deg", core.tilt_step_rad, {1.0, 45.0});
  yaml.read("min_depth_m", core.min_depth_m, {0.2, 20.0});
  yaml.read("max_depth_m", core.max_depth_m, {1.0, 30.0});
  if (core.max_depth_m <= core.min_depth_m) yaml.fail("max_depth_m", "must be beyond min_depth_m");
  yaml.read("sigma_disparity_px", core.sigma_disparity_px, {0.01, 5.0});
  yaml.read("sigma_floor_m", core.sigma_floor_m, {0.0, 0.5});
  yaml.read("sample_m", core.point_spacing_m, {0.001, 0.5});
  stereo::read_matcher(yaml.section("matcher"), core.matcher);
  read_fattening(yaml.section("rims"), core.fattening);
  read_filter(yaml.section("filter"), core.filter);
  yaml.finish();
  return config;
}

}  // namespace rover::cloud
