// True and estimated track of the rover over time and distance.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "tools/report/polyline.hpp"
#include "tools/report/run_record.hpp"

namespace rover::report {

// Time interval of the drive.
struct Window {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool contains(double t_s) const { return t_s >= begin_s && t_s <= end_s; }
};

// From the first DRIVING to the first GOAL_REACHED; default: first and last TRUTH.
Window drive_window(const RunRecord& run);

// The global paths under way within the window. One that sends the rest of the path before again only changes its
// zones.
std::vector<PathRecord> followed_paths(const RunRecord& run, const Window& window);

class TrueTrack {
 public:
  explicit TrueTrack(const std::vector<TruthSample>& truth);

  bool empty() const { return truth_.empty(); }
  // Interpolated, clamped at the ends. Requires at least one sample.
  Eigen::Isometry3d at(double t_s) const;
  // Empty before the first and after the last sample, and in gaps over 0.1 s.
  std::optional<Eigen::Isometry3d> known_at(double t_s) const;
  Pose2 planar_at(double t_s) const;
  // Horizontal distance from the first sample. Steps below 2 cm are ignored: vibration is not driving.
  double distance_m(double t_s) const;

 private:
  std::vector<TruthSample> truth_;
  std::vector<double> distance_m_;
};

// Newest sample at or before t; null if none. Samples must be sorted by t_s.
template <class Sample>
const Sample* newest(const std::vector<Sample>& samples, double t_s) {
  auto it = std::upper_bound(samples.begin(), samples.end(), t_s,
                             [](double t, const Sample& sample) { return t < sample.t_s; });
  return it == samples.begin() ? nullptr : &*std::prev(it);
}

Pose2 compose(const Pose2& a, const Pose2& b);
Pose2 inverse(const Pose2& pose);
Eigen::Vector2d transform(const Pose2& pose, const Eigen::Vector2d& p);

// Planar transform that aligns the odometry track with the truth at the start of the window.
Pose2 start_alignment(const RunRecord& run, const TrueTrack& truth, const Window& window);

struct DriftSample {
  double t_s = 0.0;
  double distance_m = 0.0;
  double error_x_m = 0.0;  // map axes, estimate minus truth
  double error_y_m = 0.0;
};
// Error of T_odom_body, aligned at the start, at each POSE in the window.
std::vector<DriftSample> odometry_drift(const RunRecord& run, const TrueTrack& truth, const Window& window);

// Position by SLAM's T_slam_odom, without external corrections. Aligned as odometry, and with the truth at its first
// pose in the window.
struct SlamTrack {
  std::vector<DriftSample> drift;     // at each SLAM_POSE, since the first
  std::vector<DriftSample> odometry;  // the same of T_odom_body
  Points line;                        // map, at each POSE from the first SLAM_POSE on
};
SlamTrack slam_track(const RunRecord& run, const TrueTrack& truth, const Window& window);

}  // namespace rover::report
