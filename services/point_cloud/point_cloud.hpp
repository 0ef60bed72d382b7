// NavCam stereo to points in the axes of the left, rectified camera, each with the standard deviation of its depth.
//
// sigma(z) = floor + z^2 / (f b) sigma_d: a matter of the depth from the camera alone. (GA SLAM's
// code takes it from the point's distance to the world's origin after the transform, so that a map gets worse along the
// way.)
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/pan_tilt.hpp"
#include "point_cloud/cloud_filter.hpp"
#include "point_cloud/rims.hpp"
#include "stereo/stereo.hpp"

namespace rover::cloud {

struct PointCloudConfig {
  stereo::MatcherConfig matcher{.residual_min_px = -40, .residual_count_px = 128};
  double tilt_step_rad = 0.0873;  // the ground plane that the matcher searches about follows the tilt in such steps
  double min_depth_m = 0.8;
  double max_depth_m = 12.0;
  double sigma_disparity_px = 0.25;  // calibration error 0.2 px rms, matching 0.1 px
  double sigma_floor_m = 0.005;
  double sample_m = 0.02;  // pixels are thinned out where they lie closer on a surface across the view
  RimConfig rims;
  FilterConfig filter;
};

struct CloudResult {
  Cloud cloud;  // may be empty
  Eigen::Isometry3d T_body_cam = nan_pose();
  double valid_fraction = 0.0;  // of the picture's pixels that have a disparity
};

class PointCloud {
 public:
  // `rig`: as calibrated, with the mount at pan and tilt zero. `ground_below_m`: of the body origin on flat ground.
  PointCloud(const PointCloudConfig& config, const StereoRig& rig, const PanTiltUnit& unit, double ground_below_m);

  int width() const { return rig_.width; }
  int height() const { return rig_.height; }
  // Empty where an image has not the rig's size.
  std::optional<CloudResult> step(const GrayImage& left, const GrayImage& right, double pan_rad, double tilt_rad);

  double sigma_m(double depth_m, const StereoCamera& camera) const;

 private:
  struct View {
    stereo::Stereo stereo;
    Eigen::Isometry3d T_left_rectified;
  };
  View& view_at(double tilt_rad);
  Cloud points_of(const Disparity& disparity, const StereoCamera& camera) const;

  PointCloudConfig config_;
  StereoRig rig_;
  PanTiltUnit unit_;
  double ground_below_m_;
  std::map<int, View> views_;  // by step of tilt, made when first needed
};

}  // namespace rover::cloud
