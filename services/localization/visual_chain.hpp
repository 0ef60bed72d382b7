// Visual motions of one keyframe, joined: their errors telescope, so the filter takes the motion since the chain's
// start as one measurement instead of many correlated ones.
#pragma once

#include "localization/filter.hpp"
#include "localization/inputs.hpp"

namespace rover::loc {

class VisualChain {
 public:
  // Longer chains begin anew, which bounds the history that has to be kept.
  explicit VisualChain(double max_duration_s) : max_duration_s_(max_duration_s) {}

  // True where the motion goes on from the chain's end, on its keyframe.
  bool continues(const VisualMotion& motion) const;
  // Begins at the state of the filter at motion.previous_utime.
  void restart(const FilterState& anchor, const VisualMotion& first);
  void extend(const VisualMotion& motion);
  void clear() { anchor_.utime = kNever; }

  const FilterState& anchor() const { return anchor_; }
  FilterState& anchor() { return anchor_; }
  const VisualInterval& interval() const { return interval_; }

 private:
  double max_duration_s_;
  FilterState anchor_;
  Utime keyframe_utime_ = kNever;
  Matrix6d start_cov_ = Matrix6d::Zero();
  VisualInterval interval_;
};

}  // namespace rover::loc
