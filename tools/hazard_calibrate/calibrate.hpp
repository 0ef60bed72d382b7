// Extrinsic calibration of the camera over flat ground (height, pitch, roll) from recorded disparities. NLopt (BOBYQA)
// minimises a Cauchy loss on the plane model with decreasing scales, which rejects pebbles and mismatches.
#pragma once

#include <vector>

#include "hazard_detector/ground_calibration.hpp"

namespace rover::hazard {

struct CalibrateConfig {
  int step_px = 4;                               // sampling step in both image directions
  std::vector<double> scales_px{4.0, 1.0, 0.3};  // Cauchy scales, one fit each, coarse to fine
  double max_height_change_m = 0.3;              // from the initial guess
  double max_angle_change_rad = 0.26;            // 15 deg
  double inlier_px = 1.0;
  double min_inlier_fraction = 0.6;
  int min_pixels = 500;
};

struct CalibrationFit {
  bool ok = false;           // read first
  const char* failure = "";  // reason if not ok
  GroundCalibration calibration;
  double rms_px = 0.0;  // of the inliers
  double inlier_fraction = 0.0;
  int pixels = 0;
};

// Mean disparity of each pixel over the frames.
class CalibrationFrames {
 public:
  explicit CalibrationFrames(const CalibrateConfig& config) : config_(config) {}

  // False if the camera differs from that of the first frame.
  bool add(const Disparity& disparity, const StereoCamera& camera);
  int frames() const { return frames_; }
  const StereoCamera& camera() const { return camera_; }
  CalibrationFit fit(double origin_height_m) const;

 private:
  CalibrateConfig config_;
  StereoCamera camera_;
  int frames_ = 0;
  std::vector<double> sum_px_;
  std::vector<int> count_;
};

}  // namespace rover::hazard
