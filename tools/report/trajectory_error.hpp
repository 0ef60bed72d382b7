// How far an estimated trajectory is from the true one, in the metrics that odometry is compared by.
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

// KITTI's metric (Geiger, Lenz and Urtasun 2012): error of the motion over every stretch of the length, per metre of
// it.
struct SegmentError {
  double length_m = 0.0;
  int count = 0;
  double translation_percent = kNaN;
  double rotation_deg_per_m = kNaN;
};

struct TrajectoryError {
  int poses = 0;
  double length_m = kNaN;     // of the true trajectory, in space
  double end_error_m = kNaN;  // with the first poses on each other
  double end_error_percent = kNaN;
  double ate_rmse_m = kNaN;  // after the rigid motion that fits best (Umeyama 1991, without scale)
  double ate_max_m = kNaN;
  std::vector<SegmentError> segments;
  SegmentError all_segments;  // over all lengths
};

// All NaN below two poses. KITTI's own lengths are 100 to 800 m; these are for shorter ways.
TrajectoryError trajectory_error(const std::vector<PosePair>& poses,
                                 const std::vector<double>& lengths_m = {10.0, 20.0, 30.0, 40.0, 50.0});

// Visual odometry alone: its motions put together, at each exposure it speaks of. A motion that does not begin where
// the one before has ended is put there all the same: what was not seen is an error. Both: only where truth is known.
std::vector<PosePair> visual_poses(const RunRecord& run, const TrueTrack& truth);
// Localization's T_map_body as it was published, at the same exposures.
std::vector<PosePair> published_poses(const RunRecord& run, const TrueTrack& truth);

}  // namespace rover::report
