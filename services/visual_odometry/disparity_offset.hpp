// Online self-calibration of the constant disparity error, from the rigidity of the ground.
//
// A disparity error distorts depth, so far and near points seem to move differently. The estimated offset makes the
// points most rigid (Dang, Hoffmann & Stiller, "Continuous stereo self-calibration by camera parameter tracking", IEEE
// TIP 2009, reduced to one parameter). It is unobservable at standstill, and bounded because calibration errors are
// small. Uncorrected, 0.2 px cause 0.5 % of scale error.
#pragma once

namespace rover::vo {

struct DisparityOffsetConfig {
  double prior_sigma_px = 0.2;  // of the camera calibration
  double max_px = 0.5;
  // Factor on the information of each measurement: residuals of one keyframe, and of one place, are correlated.
  double information_factor = 0.02;
};

// Derivatives of half the chi-square of one registration by the offset, with the motion marginalised.
struct OffsetMeasurement {
  double gradient = 0.0;     // 1/px, positive: a larger offset fits better
  double information = 0.0;  // 1/px^2
};

// What the newest measurements show; older ones are forgotten.
struct OffsetEvidence {
  double information = 0.0;
  double gradient = 0.0;  // at an offset of 0
};

class DisparityOffset {
 public:
  explicit DisparityOffset(const DisparityOffsetConfig& config);

  // To be added to each measured disparity.
  double px() const { return px_; }
  // The newest measurements show twice the bound and more, by two standard deviations; the estimate of all is slow.
  bool displaced() const;
  const OffsetEvidence& recent() const { return recent_; }
  void restore(const OffsetEvidence& recent) { recent_ = recent; }
  // `used_px`: offset applied while measuring.
  void add(const OffsetMeasurement& measurement, double used_px);

 private:
  DisparityOffsetConfig config_;
  double px_ = 0.0;
  double information_;
  OffsetEvidence recent_;
};

}  // namespace rover::vo
