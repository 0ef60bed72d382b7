#include "tools/report/no_truth.hpp"

#include "tools/report/track.hpp"

namespace rover::report {
namespace {

constexpr double kSpeedOverS = 0.5;  // interval for speeds: differences of successive poses are too noisy

}  // namespace

RunRecord with_estimate_for_truth(const RunRecord& run) {
  RunRecord out = run;
  for (const PoseSample& pose : run.poses) {
    TruthSample sample;
    sample.t_s = pose.t_s;
    sample.T_map_body = pose.T_map_odom * pose.T_odom_body;
    sample.wheel_slip = kNaN;
    const PoseSample* before = newest(run.poses, pose.t_s - kSpeedOverS);
    if (before != nullptr)
      sample.speed_mps = (pose.T_odom_body.translation() - before->T_odom_body.translation()).head<2>().norm() /
                         (pose.t_s - before->t_s);
    out.truth.push_back(sample);
  }
  return out;
}

void leave_out_truth_figures(Metrics& m) {
  m.min_clearance_m = m.hazard_clearance_m = m.motion_without_lease_s = kNaN;
  m.truth_deviation_max_m = m.odometry_drift_percent = m.odometry_drift_max_m = m.slam_drift_percent =
      m.slam_odometry_ratio = kNaN;
  m.estimate_error_max_m = m.corrected_error_max_m = kNaN;
  m.final_error_m = m.final_estimate_error_m = kNaN;
  m.anees = m.anees_after_fix = {};
  m.visual_consistency = {};
  m.visual_odometry = m.published_pose = {};
  m.map = {};
  m.final_truth_pose.reset();
  m.rocks_encountered.reset();
  m.rocks_detected.reset();
  m.rocks_missed.reset();
  m.false_stops.reset();
  for (CorrectionFigure& correction : m.global_corrections)
    correction.before_m = correction.after_m = correction.correction_error_m = kNaN;
}

}  // namespace rover::report
