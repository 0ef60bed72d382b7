// Online self-calibration of the relative roll and focal length of the stereo pair, from the rows of its matches.
//
// In a rectified pair a point lies in the same row of both images, whatever the scene (epipolar constraint; Dang,
// Hoffmann & Stiller, "Continuous stereo self-calibration by camera parameter tracking", IEEE TIP 2009). An error of
// the right camera's rotation and focal length shifts it by
//   rows:     pitch + roll * x + focal * y
//   columns:  yaw - roll * y + focal * x
// to first order, with x (right) and y (down) in half image widths from the centre. So the rows tell how the error of
// the disparity varies over the image. Its constant part, yaw, does not show in the rows: see disparity_offset.hpp.
// Observable at standstill too.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "visual_odometry/disparity_offset.hpp"

namespace rover::vo {

struct RowOffset {
  Eigen::Vector2d position;  // x, y
  double px;                 // row in the right image - row in the left image
};

class EpipolarCalibration {
 public:
  // prior_sigma_px: of each parameter; max_px: bound of roll and focal.
  explicit EpipolarCalibration(const DisparityOffsetConfig& config);

  // The matches of one new keyframe. Wrong ones are weighted down, and all as far as the model does not explain them.
  void add(const std::vector<RowOffset>& offsets);
  double roll_px() const;   // at x = 1
  double focal_px() const;  // the same

 private:
  DisparityOffsetConfig config_;
  Eigen::Matrix3d information_;  // of pitch, roll, focal
  Eigen::Vector3d weighted_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d estimate_ = Eigen::Vector3d::Zero();
};

}  // namespace rover::vo
