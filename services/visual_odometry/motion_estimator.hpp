// Camera motion from 3-D points of the keyframe and their pixels in the current pair.
//   ransac  minimal sets of three points, solved by Newton on the left image from the predicted motion, as in libviso2
//           (Geiger et al., IV 2011)
//   refine  robust Gauss-Newton on (u_left, v, u_right), weighted by pixel noise and by the depth noise of the
//           keyframe's point along its ray (Matthies & Shafer, 1987)
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/image.hpp"
#include "visual_odometry/disparity_offset.hpp"

namespace rover::vo {

struct MotionConfig {
  int ransac_iterations = 200;
  double coarse_gate_px = 3.0;       // inlier gate of RANSAC on coarse tracks
  double confidence = 0.9999;        // RANSAC stops early at this confidence
  double pixel_sigma_px = 0.20;      // of a tracked pixel
  double disparity_sigma_px = 0.15;  // of the keyframe's disparity
  double gate_sigma = 3.5;           // inlier gate of the refinement
};

struct Observation {
  Eigen::Vector3d p_key = Eigen::Vector3d::Zero();
  double disparity_px = 0.0;                    // in the keyframe
  Eigen::Vector3d z = Eigen::Vector3d::Zero();  // u_left, v, u_right
  bool has_right = false;
};

struct RansacResult {
  Eigen::Isometry3d T_cur_key = Eigen::Isometry3d::Identity();
  int inliers = 0;
};

struct MotionEstimate {
  Eigen::Isometry3d T_cur_key = nan_pose();
  Matrix6d cov = nan_cov();  // (translation, rotation), left perturbation of T_cur_key
  int inliers = 0;
  OffsetMeasurement offset;
  double rms_px = kNaN;  // reprojection error of the inliers, per coordinate
};

RansacResult ransac(const std::vector<Observation>& observations, const StereoCamera& camera,
                    const Eigen::Isometry3d& T_guess, const MotionConfig& config, std::uint64_t seed);

MotionEstimate refine(const std::vector<Observation>& observations, const StereoCamera& camera,
                      const Eigen::Isometry3d& T_start, const MotionConfig& config);

}  // namespace rover::vo
