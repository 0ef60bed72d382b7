#include "tools/report/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rover::report {
namespace {

using Eigen::Isometry3d;

std::vector<double> arc_lengths_m(const std::vector<PosePair>& poses) {
  std::vector<double> arc_m = {0.0};
  for (size_t i = 1; i < poses.size(); ++i)
    arc_m.push_back(arc_m.back() + (poses[i].truth.translation() - poses[i - 1].truth.translation()).norm());
  return arc_m;
}

// Relative pose error from i to j, in the frame of j.
Isometry3d motion_error(const PosePair& i, const PosePair& j) {
  return (i.estimate.inverse() * j.estimate).inverse() * (i.truth.inverse() * j.truth);
}

class Mean {
 public:
  void add(double translation_percent, double rotation_deg_per_m) {
    ++count_;
    translation_ += translation_percent;
    rotation_ += rotation_deg_per_m;
  }
  SegmentError error(double length_m) const {
    if (count_ == 0) return {length_m, 0, kNaN, kNaN};
    return {length_m, count_, translation_ / count_, rotation_ / count_};
  }

 private:
  int count_ = 0;
  double translation_ = 0.0;
  double rotation_ = 0.0;
};

void evaluate_segments(const std::vector<PosePair>& poses, const SegmentRule& rule, TrajectoryError& error) {
  const std::vector<double> arc_m = arc_lengths_m(poses);
  Mean all;
  for (const double length_m : rule.lengths_m) {
    Mean mean;
    for (size_t i = 0; i < poses.size(); i += static_cast<size_t>(rule.step)) {
      const auto end = std::lower_bound(arc_m.begin(), arc_m.end(), arc_m[i] + length_m);
      if (end == arc_m.end()) break;
      const Isometry3d off = motion_error(poses[i], poses[static_cast<size_t>(end - arc_m.begin())]);
      const double percent = 100.0 * off.translation().norm() / length_m;
      const double deg_per_m = to_deg(log_so3(off.linear()).norm()) / length_m;
      mean.add(percent, deg_per_m);
      all.add(percent, deg_per_m);
    }
    error.segments.push_back(mean.error(length_m));
  }
  error.all_segments = all.error(kNaN);
}

void evaluate_aligned(const std::vector<PosePair>& poses, TrajectoryError& error) {
  Eigen::Matrix3Xd estimate(3, poses.size()), truth(3, poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    estimate.col(static_cast<Eigen::Index>(i)) = poses[i].estimate.translation();
    truth.col(static_cast<Eigen::Index>(i)) = poses[i].truth.translation();
  }
  const Eigen::Matrix4d T = Eigen::umeyama(estimate, truth, false);
  const Eigen::Matrix3Xd off = (T.topLeftCorner<3, 3>() * estimate).colwise() + T.topRightCorner<3, 1>() - truth;
  error.ate_rmse_m = std::sqrt(off.colwise().squaredNorm().mean());
  error.ate_max_m = off.colwise().norm().maxCoeff();
}

void evaluate_steps(const std::vector<PosePair>& poses, TrajectoryError& error) {
  double sum_m2 = 0.0, sum_rad2 = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    const Isometry3d off = motion_error(poses[i - 1], poses[i]);
    sum_m2 += off.translation().squaredNorm();
    sum_rad2 += log_so3(off.linear()).squaredNorm();
  }
  const auto steps = static_cast<double>(poses.size() - 1);
  error.rpe_rmse_m = std::sqrt(sum_m2 / steps);
  error.rpe_rmse_deg = to_deg(std::sqrt(sum_rad2 / steps));
}

}  // namespace

SegmentRule segment_rule(double trajectory_m) {
  if (trajectory_m < 100.0) return {{10.0, 20.0, 30.0, 40.0, 50.0}, 1};
  return {{100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0}, 10};
}

double trajectory_length_m(const std::vector<PosePair>& poses) {
  return poses.empty() ? 0.0 : arc_lengths_m(poses).back();
}

TrajectoryError trajectory_error(const std::vector<PosePair>& poses, const SegmentRule& rule) {
  TrajectoryError error;
  error.poses = static_cast<int>(poses.size());
  if (poses.size() < 2) return error;
  error.length_m = trajectory_length_m(poses);
  error.end_error_m = motion_error(poses.front(), poses.back()).translation().norm();
  if (error.length_m > 0.0) error.end_error_percent = 100.0 * error.end_error_m / error.length_m;
  evaluate_aligned(poses, error);
  evaluate_segments(poses, rule, error);
  evaluate_steps(poses, error);
  return error;
}

std::vector<PosePair> visual_poses(const RunRecord& run, const TrueTrack& truth) {
  std::vector<PosePair> poses;
  Isometry3d T = Isometry3d::Identity();
  const auto add = [&](double t_s) {
    if (const auto true_pose = truth.known_at(t_s)) poses.push_back({*true_pose, T});
  };
  bool first = true;
  for (const VisualSample& motion : run.visual) {
    if (motion.lost) continue;
    if (std::exchange(first, false)) add(motion.from_s);
    T = T * motion.T_from_to;
    add(motion.to_s);
  }
  return poses;
}

std::vector<PosePair> published_poses(const RunRecord& run, const TrueTrack& truth) {
  std::vector<PosePair> poses;
  const auto add = [&](double t_s) {
    const PoseSample* pose = newest(run.poses, t_s);
    if (pose != nullptr && truth.known_at(t_s))
      poses.push_back({truth.at(pose->t_s), pose->T_map_odom * pose->T_odom_body});
  };
  bool first = true;
  for (const VisualSample& motion : run.visual) {
    if (std::exchange(first, false)) add(motion.from_s);
    add(motion.to_s);
  }
  return poses;
}

}  // namespace rover::report
