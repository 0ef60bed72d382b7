// The shipped NavCam and pan-tilt unit in synthetic worlds.
#pragma once

#include "point_cloud/point_cloud.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace rover::cloud {

// As in config/cameras.yaml and config/vehicle.yaml.
inline StereoRig navcam_rig() {
  StereoRig rig;
  rig.width = 640;
  rig.height = 480;
  rig.left = {818.0, 818.0, 321.5, 238.7, {-0.062, 0.031, 0.0003, 0.0002, 0.0}};
  rig.right = {818.3, 818.3, 318.9, 241.0, {-0.060, 0.030, -0.0002, 0.0001, 0.0}};
  rig.T_left_right = make_pose(rotation_from_rpy(to_rad(-0.07), to_rad(0.12), to_rad(-0.05)), {0.24, 0.0002, 0.0003});
  rig.T_body_left = make_pose(camera_rotation(to_rad(17.0)), {0.45, 0.12, 0.48});
  return rig;
}

inline PanTiltUnit navcam_unit() {
  return {.p_body_axes = {0.42, 0.0, 0.44},
          .pan_max_rad = to_rad(120.0),
          .tilt_min_rad = to_rad(-20.0),
          .tilt_max_rad = to_rad(45.0),
          .rate_radps = to_rad(20.0)};
}

constexpr double kGroundBelow = 0.62;

// Renders the NavCam pair of a world given in body axes.
inline synthetic::RawPair render_pair(const synthetic::World& world, double pan_rad, double tilt_rad,
                                      double sigma_grey = 1.0) {
  StereoRig rig = navcam_rig();
  rig.T_body_left = T_body_navcam(navcam_unit(), rig.T_body_left, pan_rad, tilt_rad);
  return synthetic::render(world, rig, sigma_grey, 7);
}

inline Eigen::Vector3d in_body(const CloudResult& result, const Point& p) {
  return result.T_body_cam * Eigen::Vector3d(p.x_m, p.y_m, p.z_m);
}

}  // namespace rover::cloud
