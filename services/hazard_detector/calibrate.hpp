// Calibration of the look-up table: height, pitch and roll of the camera over flat ground, from disparities recorded
// there. The model disparity is that of a plane; NLopt (BOBYQA) minimises a robust loss that is narrowed step by step,
// so that pebbles and mismatches do not count in the end.
#pragma once

#include <vector>

#include "hazard_detector/ground_calibration.hpp"

namespace rover::hazard {

struct CalibrateConfig {
  int step_px = 4;                               // every so many pixels in both directions
  std::vector<double> scales_px{4.0, 1.0, 0.3};  // of the Cauchy loss, one fit each
  double max_height_change_m = 0.3;              // against the start
  double max_angle_change_rad = 0.26;            // 15 deg
  double inlier_px = 1.0;
  double min_inlier_share = 0.6;
  int min_pixels = 500;
};

struct CalibrationFit {
  bool ok = false;       // read first
  const char* why = "";  // of a failure
  GroundCalibration calibration;
  double rms_px = 0.0;  // of the inliers
  double inlier_share = 0.0;
  int pixels = 0;
};

// Mean disparity of each pixel over the frames.
class CalibrationFrames {
 public:
  explicit CalibrationFrames(const CalibrateConfig& config) : config_(config) {}

  // False where the frame's camera is another one than that of the first frame.
  bool add(const Disparity& disparity, const StereoCamera& camera);
  int frames() const { return frames_; }
  const StereoCamera& camera() const { return camera_; }
  CalibrationFit fit(double ground_below_m) const;

 private:
  CalibrateConfig config_;
  StereoCamera camera_;
  int frames_ = 0;
  std::vector<double> sum_px_;
  std::vector<int> count_;
};

}  // namespace rover::hazard
