#include "tools/report/visual_consistency.hpp"

#include <Eigen/Cholesky>

namespace rover::report {
namespace {

// Of the newest exposure with the keyframe.
struct Alignment {
  double keyframe_s = kNaN;
  double to_s = kNaN;
  Eigen::Isometry3d T_keyframe_to = Eigen::Isometry3d::Identity();
  Matrix6d cov = Matrix6d::Zero();  // of position and rotation, in the axes of the keyframe

  void begin(double t_s) {
    *this = {};
    keyframe_s = to_s = t_s;
  }
  bool is_continued_by(const VisualSample& motion) const {
    return motion.keyframe_s == keyframe_s && motion.from_s == to_s;
  }
  void extend(const VisualSample& motion) {
    const Eigen::Matrix3d R = T_keyframe_to.linear();
    Matrix6d B = Matrix6d::Zero();
    B.topLeftCorner<3, 3>() = B.bottomRightCorner<3, 3>() = R;
    cov = B * motion.cov * B.transpose();
    T_keyframe_to = T_keyframe_to * motion.T_from_to;
    to_s = motion.to_s;
  }
};

template <int kSize>
double nees(const Eigen::Vector<double, kSize>& error, const Eigen::Matrix<double, kSize, kSize>& cov) {
  return error.dot(cov.llt().solve(error)) / kSize;
}

}  // namespace

VisualConsistency visual_consistency(const RunRecord& run, const TrueTrack& truth) {
  VisualConsistency out;
  double translation = 0.0, rotation = 0.0, together = 0.0;
  const auto finish = [&](const Alignment& alignment) {
    const auto from = truth.known_at(alignment.keyframe_s), to = truth.known_at(alignment.to_s);
    if (!(alignment.to_s > alignment.keyframe_s) || !from || !to) return;
    if (!alignment.cov.allFinite() || alignment.cov.llt().info() != Eigen::Success) return;
    const Eigen::Isometry3d T_true = from->inverse() * *to;
    Eigen::Vector<double, 6> error;
    error << T_true.translation() - alignment.T_keyframe_to.translation(),
        log_so3(T_true.linear() * alignment.T_keyframe_to.linear().transpose());
    translation += nees<3>(error.head<3>(), alignment.cov.topLeftCorner<3, 3>());
    rotation += nees<3>(error.tail<3>(), alignment.cov.bottomRightCorner<3, 3>());
    together += nees<6>(error, alignment.cov);
    ++out.keyframes;
  };
  Alignment alignment;
  for (const VisualSample& motion : run.visual) {
    if (motion.keyframe_s != alignment.keyframe_s) {
      finish(alignment);
      alignment.begin(motion.keyframe_s);
    }
    if (!motion.lost && alignment.is_continued_by(motion)) alignment.extend(motion);
  }
  finish(alignment);
  if (out.keyframes == 0) return out;
  out.translation = translation / out.keyframes;
  out.rotation = rotation / out.keyframes;
  out.together = together / out.keyframes;
  return out;
}

}  // namespace rover::report
