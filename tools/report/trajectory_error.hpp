// Trajectory error metrics as used for odometry benchmarks.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/core/frames.hpp"
#include "tools/report/run_record.hpp"
#include "tools/report/track.hpp"

namespace rover::report {

struct PosePair {
  Eigen::Isometry3d truth;     // in any frame
  Eigen::Isometry3d estimate;  // in any other
};

// Segments of the KITTI metric (Geiger, Lenz and Urtasun 2012).
struct SegmentRule {
  std::vector<double> lengths_m;
  int step = 1;  // poses from the begin of a segment to that of the next
};

// Those of KITTI's development kit from 100 m on, for a shorter trajectory lengths that suit it.
SegmentRule segment_rule(double trajectory_m);

// KITTI metric: relative error over all segments of a length, per metre.
struct SegmentError {
  double length_m = 0.0;
  int count = 0;
  double translation_percent = kNaN;
  double rotation_deg_per_m = kNaN;
};

struct TrajectoryError {
  int poses = 0;
  double length_m = kNaN;     // of the true trajectory, 3-D
  double end_error_m = kNaN;  // with aligned first poses
  double end_error_percent = kNaN;
  double ate_rmse_m = kNaN;  // absolute trajectory error after rigid alignment (Umeyama 1991, without scale)
  double ate_max_m = kNaN;
  double rpe_rmse_m = kNaN;  // relative pose error from pose to pose, as evo_rpe computes it by default
  double rpe_rmse_deg = kNaN;
  std::vector<SegmentError> segments;
  SegmentError all_segments;  // over all lengths
};

// All NaN below two poses.
TrajectoryError trajectory_error(const std::vector<PosePair>& poses, const SegmentRule& rule);

// Of the true trajectory, 3-D.
double trajectory_length_m(const std::vector<PosePair>& poses);

// Integrated VO motions at each exposure. A motion after a gap is appended without it: unobserved motion counts as
// error.
std::vector<PosePair> visual_poses(const RunRecord& run, const TrueTrack& truth);
// Published T_map_body at the same exposures.
std::vector<PosePair> published_poses(const RunRecord& run, const TrueTrack& truth);

}  // namespace rover::report
