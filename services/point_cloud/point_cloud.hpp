// NavCam stereo to points in the left rectified camera, each with the brightness of its ground and the standard
// deviation of its depth: sigma(z) = floor + z^2 / (f b) sigma_d, with z from the camera (GA SLAM's code uses the
// distance to the world's origin, which degrades the map as the rover drives).
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/pan_tilt.hpp"
#include "common/stereo/stereo.hpp"
#include "point_cloud/cloud_filter.hpp"
#include "point_cloud/foreground_fattening.hpp"

namespace rover::cloud {

struct PointCloudConfig {
  stereo::MatcherConfig matcher{
      .residual_min_px = -40, .residual_count_px = 128, .speckle_px = 200, .speckle_step_px16 = 3};
  double tilt_step_rad = to_rad(5.0);  // the matcher's ground plane follows the tilt in such steps
  double min_depth_m = 0.8;
  double max_depth_m = 10.0;
  double sigma_disparity_px = 0.25;  // calibration error 0.2 px rms, matching 0.1 px
  double sigma_floor_m = 0.005;
  double point_spacing_m = 0.02;  // minimum distance of pixels on a fronto-parallel surface
  FatteningConfig foreground_fattening;
  FilterConfig filter;
};

struct CloudResult {
  Cloud cloud;  // may be empty
  Eigen::Isometry3d T_body_cam = nan_pose();
  double valid_fraction = 0.0;  // of the pixels: with a disparity
};

class PointCloud {
 public:
  // `rig`: mount at pan and tilt zero. `ground_below_m`: height of the body origin above flat ground.
  PointCloud(const PointCloudConfig& config, const StereoRig& rig, const PanTiltUnit& unit, double ground_below_m);

  int width() const { return rig_.width; }
  int height() const { return rig_.height; }
  // Empty if an image's size differs from the rig's. `exposure_s`: of the left image; 0: unknown, taken for 1.
  std::optional<CloudResult> step(const GrayImage& left, const GrayImage& right, double pan_rad, double tilt_rad,
                                  double exposure_s = 0.0);

  // The same from the disparity of the camera at this tilt, without brightness.
  CloudResult from_disparity(Disparity disparity, double pan_rad, double tilt_rad);
  const StereoCamera& camera_at(double tilt_rad) { return stereo_at_tilt(tilt_rad).stereo.camera(); }

  double sigma_m(double depth_m, const StereoCamera& camera) const;

 private:
  struct TiltedStereo {
    stereo::Stereo stereo;
    Eigen::Isometry3d T_left_rectified;
  };
  TiltedStereo& stereo_at_tilt(double tilt_rad);
  // `left`: the rectified image, or null.
  CloudResult cloud_of(Disparity disparity, const GrayImage* left, double exposure_s, double pan_rad, double tilt_rad);
  Cloud triangulate(const Disparity& disparity, const StereoCamera& camera, const GrayImage* left,
                    double exposure_s) const;

  PointCloudConfig config_;
  StereoRig rig_;
  PanTiltUnit unit_;
  double ground_below_m_;
  std::map<int, TiltedStereo> stereo_by_tilt_;  // key: tilt step; created on demand
};

}  // namespace rover::cloud
