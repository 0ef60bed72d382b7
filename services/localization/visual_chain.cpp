#include "localization/visual_chain.hpp"

namespace rover::loc {

bool VisualChain::continues(const VisualMotion& motion) const {
  return anchor_.utime != kNever && motion.keyframe_utime == keyframe_utime_ && motion.previous_utime == interval_.to &&
         to_seconds(motion.utime - anchor_.utime) <= max_duration_s_;
}

void VisualChain::restart(const FilterState& anchor, Utime keyframe_utime) {
  anchor_ = anchor;
  keyframe_utime_ = keyframe_utime;
  interval_ = {anchor.utime, anchor.utime, Eigen::Isometry3d::Identity(), Matrix6d::Zero()};
}

void VisualChain::extend(const VisualMotion& motion) {
  const Eigen::Matrix3d R = interval_.T_from_to.linear();
  Matrix6d A = Matrix6d::Identity();
  A.topRightCorner<3, 3>() = -skew(R * motion.T_prev_cur.translation());
  Matrix6d B = Matrix6d::Zero();
  B.topLeftCorner<3, 3>() = R;
  B.bottomRightCorner<3, 3>() = R;
  interval_.cov = A * interval_.cov * A.transpose() + B * motion.cov * B.transpose();
  interval_.T_from_to = interval_.T_from_to * motion.T_prev_cur;
  interval_.to = motion.utime;
}

}  // namespace rover::loc
