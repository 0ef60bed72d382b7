#include "pan_tilt/config.hpp"

#include <cmath>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::gaze {
namespace {

CameraMount mount_of(const Vehicle& vehicle, const StereoRig& navcam) {
  const Eigen::Vector3d forward = navcam.T_body_left.linear() * Eigen::Vector3d::UnitZ();
  return {vehicle.origin_height_m + navcam.T_body_left.translation().z(), -std::asin(forward.z()),
          vehicle.pan_tilt->p_body_axes.x()};
}

void read_ahead(const Config& yaml, LookAheadConfig& ahead) {
  yaml.read("distance_m", ahead.distance_m, {0.5, 20.0});
  yaml.read_deg("pan_max_deg", ahead.pan_max_rad, {0.0, 120.0});
  yaml.read("near_m", ahead.near_m, {0.5, 10.0});
  yaml.read("far_m", ahead.far_m, {1.0, 50.0});
  if (ahead.far_m <= ahead.near_m) yaml.fail("far_m", "must be beyond near_m");
}

void read_sweep(const Config& yaml, SweepConfig& sweep) {
  yaml.read_deg("pan_max_deg", sweep.pan_max_rad, {0.0, 180.0});
  yaml.read_deg("pan_step_deg", sweep.pan_step_rad, {5.0, 90.0});
  double far_deg = to_deg(sweep.tilts_rad.front()), near_deg = to_deg(sweep.tilts_rad.back());
  yaml.read("far_tilt_deg", far_deg, {-45.0, 90.0});
  yaml.read("near_tilt_deg", near_deg, {-45.0, 90.0});
  sweep.tilts_rad = {to_rad(far_deg), to_rad(near_deg)};
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  const Vehicle vehicle = load_vehicle(config_dir);
  if (!vehicle.pan_tilt) throw ConfigError(config_dir + "/vehicle.yaml: pan_tilt: missing, there is nothing to turn");
  config.unit = *vehicle.pan_tilt;
  config.mount = mount_of(vehicle, load_stereo_rig(config_dir, "navcam"));
  const Config yaml = Config::load(config_dir + "/pan_tilt.yaml");
  yaml.read("max_state_age_s", config.max_state_age_s, {0.2, 10.0});
  yaml.read("max_pose_age_s", config.core.max_pose_age_s, {0.05, 10.0});
  yaml.read("image_way_m", config.core.image_distance_m, {0.05, 10.0});
  yaml.read_deg("image_turn_deg", config.core.image_turn_rad, {1.0, 180.0});
  yaml.read_deg("glance_deg", config.core.glance_rad, {0.0, 120.0});
  yaml.read("stuck_s", config.core.stuck_s, {0.0, 100.0});
  yaml.read("dwell_s", config.core.dwell_s, {0.02, 5.0});
  yaml.read("arrival_slack_s", config.core.arrival_margin_s, {0.1, 60.0});
  yaml.read_deg("arrival_deg", config.core.arrival_rad, {0.01, 10.0});
  read_ahead(yaml.section("ahead"), config.core.ahead);
  read_sweep(yaml.section("sweep"), config.core.sweep);
  yaml.finish();
  return config;
}

}  // namespace rover::gaze
