// Rectification with precomputed remap tables.
//
// The matching pair is padded, so no disparity is lost at the edges, and its right image is sheared by the disparity of
// a reference plane (plane plus parallax). Near that plane the residual is small and nearly constant over a block,
// although the disparity changes by 0.15 px per row.
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
  // Reference plane z_body = -origin_height_m; empty: the plane at infinity (no shear).
  Rectifier(const StereoRig& rig, const MatchPad& pad, std::optional<double> origin_height_m);

  const StereoCamera& camera() const { return camera_; }
  const MatchPad& pad() const { return pad_; }
  // Disparity removed by the shear, over rectified left coordinates.
  const DisparityPlane& reference() const { return reference_; }
  // 255 where the sheared right image has camera data.
  const cv::Mat& match_right_valid() const { return match_right_valid_; }

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
  cv::Mat match_right_valid_;
};

}  // namespace rover::stereo
