// The constant part of the disparity's calibration error, found from the rigidity of the ground.
//
// An error of the disparity bends space: far points seem to move more, or less, than near ones. The bend that leaves
// the points most rigid is the error's estimate (as Dang, Hoffmann & Stiller, "Continuous stereo self-calibration by
// camera parameter tracking", IEEE TIP 2009, but this one parameter alone). It needs neither wheels nor a known height,
// says nothing at standstill, and is bounded: calibration errors are small. Uncorrected, 0.2 px make 0.5 % of scale
// error.
#pragma once

namespace rover::vo {

struct DisparityOffsetConfig {
  double prior_sigma_px = 0.2;  // of calibration
  double max_px = 0.5;
  // Share of the information that is believed: what makes the residuals of one keyframe, and of one place, alike.
  double believed_share = 0.02;
};

// What one alignment tells: the derivative of half its chi-square by the offset, and its curvature, with the motion
// estimated along (Schur complement).
struct OffsetEvidence {
  double gradient = 0.0;     // 1/px, positive: a larger offset fits better
  double information = 0.0;  // 1/px^2
};

class DisparityOffset {
 public:
  explicit DisparityOffset(const DisparityOffsetConfig& config);

  // To be added to every measured disparity.
  double px() const { return px_; }
  double sigma_px() const;
  // `used_px`: the offset with which the evidence was taken.
  void add(const OffsetEvidence& evidence, double used_px);

 private:
  DisparityOffsetConfig config_;
  double px_ = 0.0;
  double information_;
};

}  // namespace rover::vo
