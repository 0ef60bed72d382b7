// The pan-tilt unit that carries the NavCam: a pan axis along body z, on it a tilt axis that is body y at pan zero.
// Pan is positive to the left, tilt positive down; the camera's mount in cameras.yaml is that at pan and tilt zero.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "common/core/frames.hpp"

namespace rover {

struct PanTiltUnit {
  Eigen::Vector3d p_body_axes = Eigen::Vector3d::Zero();  // intersection of the axes [m]
  double pan_max_rad = 0.0;                               // to either side
  double tilt_min_rad = 0.0;                              // upwards: negative
  double tilt_max_rad = 0.0;
  double rate_radps = 0.0;  // of each axis

  double clamp_pan(double pan_rad) const { return std::clamp(pan_rad, -pan_max_rad, pan_max_rad); }
  double clamp_tilt(double tilt_rad) const { return std::clamp(tilt_rad, tilt_min_rad, tilt_max_rad); }
};

// Pose of a camera on the unit; `T_body_mount`: its pose at pan and tilt zero.
inline Eigen::Isometry3d T_body_navcam(const PanTiltUnit& unit, const Eigen::Isometry3d& T_body_mount, double pan_rad,
                                       double tilt_rad) {
  const Eigen::Isometry3d T_body_turned = make_pose(rotation_from_rpy(0.0, tilt_rad, pan_rad), unit.p_body_axes);
  return T_body_turned * Eigen::Translation3d(-unit.p_body_axes) * T_body_mount;
}

}  // namespace rover
