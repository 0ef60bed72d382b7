#include "tools/report/pose_consistency.hpp"

#include <Eigen/Cholesky>

#include "common/core/time.hpp"

namespace rover::report {
namespace {

constexpr double kEveryS = 1.0;

// x, y, yaw in map axes, as localization defines its error state.
Eigen::Vector3d error_of(const PoseSample& pose, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d estimate = pose.T_map_odom * pose.T_odom_body;
  const Eigen::Vector3d shift = truth.translation() - estimate.translation();
  return {shift.x(), shift.y(), log_so3(truth.linear() * estimate.linear().transpose()).z()};
}

}  // namespace

PoseConsistency pose_consistency(const RunRecord& run, const TrueTrack& truth, const Window& window) {
  Eigen::Vector3d each = Eigen::Vector3d::Zero();
  double together = 0.0;
  PoseConsistency out;
  double next_s = window.begin_s;
  for (const PoseSample& pose : run.poses) {
    if (truth.empty() || !window.contains(pose.t_s) || pose.t_s < next_s) continue;
    const Eigen::LLT<Eigen::Matrix3d> factor(pose.cov_xyyaw);
    if (!pose.cov_xyyaw.allFinite() || factor.info() != Eigen::Success) continue;
    next_s = pose.t_s + kEveryS;
    const Eigen::Vector3d error = error_of(pose, truth.at(pose.t_s));
    each += error.cwiseAbs2().cwiseQuotient(pose.cov_xyyaw.diagonal());
    together += error.dot(factor.solve(error)) / 3.0;
    ++out.samples;
  }
  if (out.samples == 0) return out;
  each /= out.samples;
  out.x = each.x();
  out.y = each.y();
  out.yaw = each.z();
  out.xyyaw = together / out.samples;
  return out;
}

double first_fix_s(const RunRecord& run) {
  for (const CorrectionRecord& correction : run.corrections)
    if (correction.accepted) return correction.released_s + to_seconds(kTickUs);
  return kInfinity;
}

}  // namespace rover::report
