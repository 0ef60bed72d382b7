#include "pan_tilt/config.hpp"

#include <cmath>

#include "common/bus/vehicle_config.hpp"

namespace rover::gaze {
namespace {

CameraMount mount_of(const Vehicle& vehicle, const StereoRig& navcam) {
  const Eigen::Vector3d forward = navcam.T_body_left.linear() * Eigen::Vector3d::UnitZ();
  return {vehicle.origin_height_m + navcam.T_body_left.translation().z(), -std::asin(forward.z()),
          vehicle.pan_tilt->p_body_axes.x()};
}

void add_ahead(Parameters p, LookAheadConfig& c) {
  p.add("distance_m", c.distance_m, {0.5, 20.0}, "of the lookahead point along the path");
  p.add_deg("pan_max_deg", c.pan_max_rad, {0.0, 120.0}, "to either side");
  p.add("near_m", c.near_m, {0.5, 10.0}, "start of the ground to be seen, from the camera");
  p.add("far_m", c.far_m, {1.0, 50.0}, "its end");
  p.check(c.far_m > c.near_m, "far_m", "must be beyond near_m");
}

void add_sweep(Parameters p, SweepConfig& c) {
  p.add_deg("pan_max_deg", c.pan_max_rad, {0.0, 180.0},
            "81 deg to either side with half of the field of view of 43 deg");
  p.add_deg("pan_step_deg", c.pan_step_rad, {5.0, 90.0}, "at 1.3 m both cameras see 25 deg");
  p.add_deg("far_tilt_deg", c.far_tilt_rad, {-45.0, 90.0}, "sees ground from 1.7 m in front of the camera");
  p.add_deg("near_tilt_deg", c.near_tilt_rad, {-45.0, 90.0}, "sees 0.7 to 2.4 m");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  PanTiltConfig& c = config.core;
  const Vehicle vehicle = load_vehicle(config_dir);
  if (!vehicle.pan_tilt) throw ConfigError(config_dir + "/vehicle.yaml: pan_tilt: missing, there is nothing to turn");
  config.unit = *vehicle.pan_tilt;
  config.mount = mount_of(vehicle, load_stereo_rig(config_dir, "navcam"));
  Parameters p(config_dir + "/pan_tilt.yaml",
               "Gaze control of the NavCam at the Full level. Axes, limits and rate of the unit: vehicle.yaml; camera: "
               "cameras.yaml.",
               list);
  p.add("max_state_age_s", config.max_state_age_s, {0.2, 10.0}, "of the supervisor's STATE; older: idle");
  p.add("max_pose_age_s", c.max_pose_age_s, {0.05, 10.0}, "older: no images ahead");
  p.add("image_distance_m", c.image_distance_m, {0.05, 10.0}, "distance between images ahead");
  p.add_deg("image_turn_deg", c.image_turn_rad, {1.0, 180.0}, "or turn of the rover or of the view");
  p.add_deg("glance_deg", c.glance_rad, {0.0, 120.0}, "pan of every second image ahead, alternating sides; 0: none");
  p.add("stuck_s", c.stuck_s, {0.0, 100.0}, "stopped by hazards for so long: one sweep");
  p.add("dwell_s", c.dwell_s, {0.02, 5.0}, "from arrival to the end of the exposure");
  p.add("arrival_margin_s", c.arrival_margin_s, {0.1, 60.0}, "beyond the longest move: unit timed out");
  p.add_deg("arrival_deg", c.arrival_rad, {0.01, 10.0}, "the unit has arrived within this angle");
  add_ahead(p.section("ahead", "view along the path"), c.ahead);
  add_sweep(p.section("sweep", "ten views in about 17 s"), c.sweep);
  p.finish();
  return config;
}

}  // namespace rover::gaze
