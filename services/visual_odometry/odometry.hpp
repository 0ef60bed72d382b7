// Stereo visual odometry against keyframes.
//
// Each pair is registered with the keyframe, not with the previous pair, while enough keyframe points are visible. The
// output is T_prev_cur = T_key_prev^-1 T_key_cur: its errors telescope, so drift grows with each keyframe instead of
// each pair, and is zero at standstill.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/image.hpp"
#include "common/core/time.hpp"
#include "visual_odometry/disparity_offset.hpp"
#include "visual_odometry/epipolar_calibration.hpp"
#include "visual_odometry/keyframe.hpp"
#include "visual_odometry/motion_estimator.hpp"
#include "visual_odometry/tracker.hpp"

namespace rover::vo {

struct OdometryConfig {
  int pyramid_levels = 4;
  int min_inliers = 15;                     // fewer: kLost
  int ok_inliers = 40;                      // fewer: kDegraded
  double ok_inlier_ratio = 0.35;            // inliers / tracked points; less: kDegraded
  double keyframe_inlier_ratio = 0.50;      // inliers / keyframe points; less: new keyframe
  int keyframe_inliers = 60;                // fewer: new keyframe
  int min_keyframe_points = 40;             // a pair with fewer cannot become keyframe
  int lost_until_new_keyframe = 2;          // consecutive lost pairs before a new keyframe
  double max_position_sigma_m = 0.05;       // more: kLost
  double gyro_tolerance_rad = to_rad(1.7);  // rotation difference of gyro and images; more: kDegraded
  std::uint64_t seed = 1;
  CornerConfig corners;
  StereoMatchConfig stereo;
  TrackerConfig tracker;
  MotionConfig motion;
  DisparityOffsetConfig disparity_offset;
};

struct StereoFrame {
  Utime utime = kNever;  // of the exposure
  GrayImage left;
  GrayImage right;
  std::optional<Disparity> disparity;  // dense, left image: seeds the sub-pixel matches
  StereoCamera camera;
  // Gyro rotation of the body from Odometry::previous_utime to this exposure.
  std::optional<Eigen::Matrix3d> R_prev_cur;
};

// kDisplaced: as kLost, because the disparity offset is far beyond its bound: the cameras have moved against each
// other.
enum class Status { kOk, kDegraded, kLost, kDisplaced };

struct OdometryResult {
  Status status = Status::kLost;
  Utime previous_utime = kNever;  // the motion spans previous_utime .. utime
  Utime utime = kNever;
  Utime keyframe_utime = kNever;              // exposure with which both ends were registered
  Eigen::Isometry3d T_prev_cur = nan_pose();  // current body in the previous body
  // Of (position, rotation) of the registration with the keyframe, previous body axes. A motion that starts at the
  // keyframe has this covariance; a later one has the sum of this and the previous motion's.
  Matrix6d cov = nan_cov();
  int features = 0;  // tracked
  int inliers = 0;
  double rms_px = kNaN;
};

class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config);

  // Empty if the pair became the first keyframe. Pairs must be in time order.
  std::optional<OdometryResult> step(const StereoFrame& frame);

  // Start of the next motion; kNever before the first keyframe.
  Utime previous_utime() const { return previous_utime_; }
  // Estimated error of the calibration.
  DisparityCorrection correction() const { return {offset_.px(), epipolar_.roll_px(), epipolar_.focal_px()}; }
  // Of kDisplaced, over restarts: a stationary rover finds none.
  const OffsetEvidence& offset_evidence() const { return offset_.recent(); }
  void restore(const OffsetEvidence& evidence) { offset_.restore(evidence); }

 private:
  struct StereoPyramid;
  struct Registration;
  bool start_keyframe(const StereoFrame& frame, const StereoPyramid& pyramids);
  Registration register_with_keyframe(const StereoFrame& frame, const StereoPyramid& pyramids) const;
  Registration register_from_guess(const StereoFrame& frame, const StereoPyramid& pyramids,
                                   const Eigen::Isometry3d& T_prev_cur_body, bool search) const;
  bool is_valid(const Registration& registration) const;
  OdometryResult accept(const StereoFrame& frame, const Registration& registration);
  Status classify(const StereoFrame& frame, const OdometryResult& result) const;
  OdometryResult lost(const StereoFrame& frame, const Registration& registration) const;

  OdometryConfig config_;
  DisparityOffset offset_;
  EpipolarCalibration epipolar_;
  std::optional<Keyframe> keyframe_;
  Utime keyframe_utime_ = kNever;
  Eigen::Isometry3d T_key_prev_ = Eigen::Isometry3d::Identity();  // camera axes
  Utime previous_utime_ = kNever;
  Utime newest_utime_ = kNever;
  int consecutive_lost_ = 0;
  Eigen::Isometry3d last_motion_ = Eigen::Isometry3d::Identity();  // body axes
  double last_motion_s_ = 0.0;
};

}  // namespace rover::vo
