#include "point_cloud/config.hpp"

#include "common/bus/vehicle_config.hpp"
#include "common/stereo/matcher_config.hpp"

namespace rover::cloud {
namespace {

void add_foreground_fattening(Parameters p, FatteningConfig& c) {
  p.add("min_jump_px", c.min_jump_px, {0.1, 50.0}, "of disparity, above that of steep ground");
  p.add("slope_px_per_px", c.slope_px_per_px, {0.0, 5.0},
        "disparity of steep ground per row; ground rising by 15 deg has 0.35");
  p.add("width_px", c.width_px, {0, 50}, "rows removed below a jump: half a block; 0: none");
}

void add_filter(Parameters p, FilterConfig& c) {
  p.add("voxel_m", c.voxel_m, {0.02, 0.5}, "side of a voxel (Azkarate et al. 2020)");
  p.add("outlier_radius_m", c.outlier_radius_m, {0.02, 2.0}, "at 10 m rows of ground are 0.09 m apart");
  p.add("outlier_neighbours", c.outlier_neighbours, {1, 100}, "fewer within the radius: outlier");
  p.add("max_points", c.max_points, {100, 25000},
        "the farthest are dropped; 24,900 and their brightness are a CLOUD of 0.5 MB");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  config.rig = load_stereo_rig(config_dir, "navcam");
  const Vehicle vehicle = load_vehicle(config_dir);
  if (!vehicle.pan_tilt)
    throw ConfigError(config_dir + "/vehicle.yaml: pan_tilt: missing, the NavCam is mounted on it");
  config.unit = *vehicle.pan_tilt;
  config.ground_below_m = vehicle.origin_height_m;
  PointCloudConfig& c = config.core;
  Parameters p(config_dir + "/point_cloud.yaml",
               "NavCam stereo to point cloud. Image size and calibration: cameras.yaml; pan-tilt unit: vehicle.yaml.",
               list);
  p.add_s("latency_s", config.latency_us, {0.02, 5.0}, "modelled processing time, images to cloud");
  p.add_deg("tilt_step_deg", c.tilt_step_rad, {1.0, 45.0}, "the matcher's ground plane follows the tilt in such steps");
  p.add("min_depth_m", c.min_depth_m, {0.2, 20.0}, "nearer points are dropped");
  p.add("max_depth_m", c.max_depth_m, {1.0, 30.0},
        "farther points are dropped: 20 px of disparity, 0.13 m of depth sigma; the map ends there");
  p.check(c.max_depth_m > c.min_depth_m, "max_depth_m", "must be beyond min_depth_m");
  p.add("sigma_disparity_px", c.sigma_disparity_px, {0.01, 5.0}, "calibration error 0.2 px rms, matching 0.1 px");
  p.add("sigma_floor_m", c.sigma_floor_m, {0.0, 0.5}, "depth sigma at depth zero, added to that of the disparity");
  p.add("point_spacing_m", c.point_spacing_m, {0.001, 0.5}, "minimum distance of pixels on a fronto-parallel surface");
  add_matcher(p.section("matcher",
                        "block matching; -40 px: ground falling away by 10 deg from 1.5 m ahead needs -26; +87 px: "
                        "ground rising by 15 deg needs +35, a rock 0.5 m tall 2 m ahead +45"),
              c.matcher);
  add_foreground_fattening(p.section("foreground_fattening", "removed at the upper edges of near objects"),
                           c.foreground_fattening);
  add_filter(p.section("filter", "downsampling and outlier removal (PCL)"), c.filter);
  p.finish();
  return config;
}

}  // namespace rover::cloud
