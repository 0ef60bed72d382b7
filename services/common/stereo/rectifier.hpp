// Rectification from the calibration: one map per image, made once, used for each frame.
//
// Beside the rectified pair it makes the pair that the matcher works on: wider by a pad, so that no disparity is lost
// at the edges, and with the right image sheared by the disparity of a reference plane (plane plus parallax). On ground
// near that plane all that remains to be searched is a small residual, nearly constant over a matching window, although
// the disparity itself changes by 0.15 px a row.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "common/core/camera_rig.hpp"
#include "common/core/disparity_plane.hpp"
#include "common/core/image.hpp"
#include "common/stereo/block_matcher.hpp"

namespace rover::stereo {

struct RectifiedPair {
  GrayImage left;
  GrayImage right;
  cv::Mat match_left;   // 8 bit, padded
  cv::Mat match_right;  // 8 bit, padded, sheared
};

class Rectifier {
 public:
  // The ground plane at z_body = -ground_below_m is the reference; none: the plane at infinity (no shear).
  Rectifier(const StereoRig& rig, const MatchPad& pad, std::optional<double> ground_below_m);

  const StereoCamera& camera() const { return camera_; }
  const MatchPad& pad() const { return pad_; }
  // Disparity that the shear has taken out, over the coordinates of the rectified left image.
  const DisparityPlane& reference() const { return reference_; }
  // 255 where the sheared right image was seen by the camera.
  const cv::Mat& match_right_seen() const { return match_right_seen_; }

  RectifiedPair rectify(const GrayImage& left, const GrayImage& right) const;

 private:
  struct Map {
    cv::Mat xy;        // CV_16SC2
    cv::Mat fraction;  // CV_16UC1
  };

  StereoCamera camera_;
  MatchPad pad_;
  DisparityPlane reference_;
  Map left_;
  Map right_;
  Map match_right_;
  cv::Mat match_right_seen_;
};

}  // namespace rover::stereo
