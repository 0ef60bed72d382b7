// An unrectified stereo rig: two pinhole cameras with distortion, in one of two models.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace rover {

enum class DistortionModel {
  kRadTan,       // k1 k2 p1 p2 k3: OpenCV's five parameters
  kEquidistant,  // k1 k2 k3 k4 over the angle from the axis: OpenCV's fisheye; the fifth is 0
};

struct PinholeCamera {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 5> distortion{};
  DistortionModel model = DistortionModel::kRadTan;  // the same for both cameras of a rig
};

struct StereoRig {
  int width = 0;
  int height = 0;
  PinholeCamera left;
  PinholeCamera right;
  Eigen::Isometry3d T_left_right = Eigen::Isometry3d::Identity();  // right camera in left camera axes
  Eigen::Isometry3d T_body_left = Eigen::Isometry3d::Identity();
};

}  // namespace rover
