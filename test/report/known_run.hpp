// Runs with known metrics.
#pragma once

#include "tools/report/metrics.hpp"

namespace rover::report {

inline Eigen::Isometry3d pose_at(double x_m, double y_m, double yaw_rad = 0.0) {
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw_rad), {x_m, y_m, 0.62});
}

// Straight along x at 0.1 m/s, samples every 0.5 s, stationary for 5 s before and after. DRIVING from 5 s. Estimate =
// truth.
inline RunRecord straight_run(double length_m) {
  constexpr double kSpeed = 0.1;
  constexpr double kStep = 0.5;
  constexpr double kRest = 5.0;
  RunRecord run;
  const double end_s = kRest + length_m / kSpeed;
  run.states = {
      {0.0, State::kStandby, false, ""}, {kRest, State::kDriving, false, ""}, {end_s, State::kGoalReached, false, ""}};
  run.global_paths = {{0.0, 1, false, false, {{0.0, 0.0}, {length_m, 0.0}}}};
  for (double t = 0.0; t <= end_s + kRest; t += kStep) {
    const double x = std::min(std::max(0.0, t - kRest) * kSpeed, length_m);
    TruthSample truth;
    truth.t_s = t;
    truth.T_map_body = pose_at(x, 0.0);
    truth.clearance_m = 0.3;
    run.truth.push_back(truth);
    run.poses.push_back({t, pose_at(x, 0.0), Eigen::Isometry3d::Identity()});
    run.control.push_back({t, t < kRest ? Following::kIdle : Following::kFollowing, 1, 0.0});
  }
  return run;
}

// Hazard map with one cell at the body point.
inline HazardMap hazard_at(double t_s, double x_body_m, double y_body_m, double latency_s = 0.3) {
  HazardMap map;
  map.t_s = t_s;
  map.released_s = t_s + latency_s;
  map.coverage = 0.9;
  map.cells = {{{x_body_m, y_body_m}, false}};
  return map;
}

inline Metrics figures(const RunRecord& run, const std::optional<TrueWorld>& world = std::nullopt) {
  return evaluate(run, RunInfo{}, Footprint{}, world).metrics;
}

}  // namespace rover::report
