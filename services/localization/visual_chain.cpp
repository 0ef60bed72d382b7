#include "localization/visual_chain.hpp"

namespace rover::loc {

bool VisualChain::is_continued_by(const VisualMotion& motion) const {
  return anchor_.utime != kNever && motion.keyframe_utime == keyframe_utime_ && motion.previous_utime == interval_.to &&
         to_seconds(motion.utime - anchor_.utime) <= max_duration_s_;
}

void VisualChain::restart(const FilterState& anchor, const VisualMotion& first) {
  anchor_ = anchor;
  keyframe_utime_ = first.keyframe_utime;
  // No alignment error at the keyframe itself; later, the anchor's is about that of the first motion.
  start_cov_ = first.previous_utime == first.keyframe_utime ? Matrix6d::Zero() : first.cov;
  interval_ = {anchor.utime, anchor.utime, Eigen::Isometry3d::Identity(), Matrix6d::Zero()};
}

void VisualChain::extend(const VisualMotion& motion) {
  const Eigen::Matrix3d R = interval_.T_from_to.linear();
  interval_.T_from_to = interval_.T_from_to * motion.T_prev_cur;
  interval_.to = motion.utime;
  Matrix6d A = Matrix6d::Identity();
  A.topRightCorner<3, 3>() = -skew(interval_.T_from_to.translation());
  Matrix6d B = Matrix6d::Zero();
  B.topLeftCorner<3, 3>() = R;
  B.bottomRightCorner<3, 3>() = R;
  interval_.cov = A * start_cov_ * A.transpose() + B * motion.cov * B.transpose();
}

}  // namespace rover::loc
