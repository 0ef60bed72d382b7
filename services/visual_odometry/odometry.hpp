// Stereo visual odometry against keyframes.
//
// Each pair is aligned with the keyframe, not with the pair before, as long as enough of the keyframe's points are
// seen. What is reported between two pairs is T_prev_cur = T_key_prev^-1 T_key_cur: the chain telescopes, so a rover
// that stands still does not drift, and one that drives makes an error once a keyframe instead of once a pair.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/image.hpp"
#include "common/core/time.hpp"
#include "visual_odometry/disparity_offset.hpp"
#include "visual_odometry/keyframe.hpp"
#include "visual_odometry/motion_estimator.hpp"
#include "visual_odometry/tracker.hpp"

namespace rover::vo {

struct OdometryConfig {
  int pyramid_levels = 4;
  int min_inliers = 15;                     // fewer: kLost
  int ok_inliers = 40;                      // fewer: kDegraded
  double ok_share = 0.35;                   // inliers of the points tracked; less: kDegraded
  double keep_share = 0.50;                 // of the keyframe's points; fewer inliers: the next keyframe is due
  int keep_inliers = 60;                    // likewise, as a count
  int min_keyframe_points = 40;             // a pair with fewer makes no keyframe
  int lost_until_restart = 2;               // pairs in a row that do not fit the keyframe until a new one is made
  double max_position_sigma_m = 0.05;       // a motion less certain than this is none
  double gyro_tolerance_rad = to_rad(1.7);  // more between gyro and images: kDegraded
  std::uint64_t seed = 1;
  CornerConfig corners;
  StereoMatchConfig stereo;
  TrackerConfig tracker;
  MotionConfig motion;
  DisparityOffsetConfig offset;
};

struct StereoFrame {
  Utime utime = kNever;  // of the exposure
  GrayImage left;
  GrayImage right;
  std::optional<Disparity> disparity;  // dense, of the left image: a start for the sub-pixel matches
  StereoCamera camera;
  // Rotation of the body from the last anchored exposure (Odometry::previous_utime) to this one, by gyro.
  std::optional<Eigen::Matrix3d> R_prev_cur;
};

enum class Status { kOk, kDegraded, kLost };

struct OdometryResult {
  Status status = Status::kLost;
  Utime previous_utime = kNever;  // the motion spans previous_utime .. utime
  Utime utime = kNever;
  Utime keyframe_utime = kNever;              // both ends were aligned with this exposure
  Eigen::Isometry3d T_prev_cur = nan_pose();  // current body in the previous body
  // Of (position, rotation) of the alignment with the keyframe, in previous body axes. Errors of one keyframe's motions
  // telescope: this is the covariance of their sum. A motion that begins at the keyframe has just this covariance, one
  // within its life the sum of this and that of the motion before.
  Matrix6d cov = nan_cov();
  int features = 0;  // tracked
  int inliers = 0;
  double rms_px = kNaN;
};

class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config);

  // Nothing for the first pair that can serve as keyframe: no motion ends there. Pairs must come in order of time.
  std::optional<OdometryResult> step(const StereoFrame& frame);

  // Exposure from which the next motion starts; kNever before the first keyframe.
  Utime previous_utime() const { return previous_utime_; }
  // Estimated calibration error of the disparity.
  const DisparityOffset& offset() const { return offset_; }

 private:
  struct Pair;
  struct Registration;
  bool start_from(const StereoFrame& frame, const Pair& pair);
  Registration register_pair(const StereoFrame& frame, const Pair& pair) const;
  Registration attempt(const StereoFrame& frame, const Pair& pair, const Eigen::Isometry3d& T_prev_cur_body,
                       bool search) const;
  bool trustworthy(const Registration& registration) const;
  OdometryResult accept(const StereoFrame& frame, const Registration& registration);
  Status judge(const StereoFrame& frame, const OdometryResult& result) const;
  OdometryResult lost(const StereoFrame& frame, const Registration& registration) const;

  OdometryConfig config_;
  DisparityOffset offset_;
  double key_offset_px_ = 0.0;  // the offset in use: changes with the keyframe only, so that its motions telescope
  std::optional<Keyframe> key_;
  Utime key_utime_ = kNever;
  Eigen::Isometry3d T_key_prev_ = Eigen::Isometry3d::Identity();  // camera axes
  Utime previous_utime_ = kNever;
  Utime newest_utime_ = kNever;
  int lost_in_a_row_ = 0;
  Eigen::Isometry3d last_motion_ = Eigen::Isometry3d::Identity();  // of the body
  double last_motion_s_ = 0.0;
};

}  // namespace rover::vo
