// Composition of the visual motions of one keyframe. Their errors telescope, so the filter fuses the motion since the
// chain's anchor as one measurement instead of many correlated ones.
#pragma once

#include "localization/filter.hpp"
#include "localization/inputs.hpp"

namespace rover::loc {

class VisualChain {
 public:
  // Longer chains restart, which bounds the history needed.
  explicit VisualChain(double max_duration_s) : max_duration_s_(max_duration_s) {}

  // True if the motion starts at the chain's end and has the same keyframe.
  bool is_continued_by(const VisualMotion& motion) const;
  // `anchor`: filter state at first.previous_utime.
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
