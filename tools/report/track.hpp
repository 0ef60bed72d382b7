// The true and the estimated way of the rover, by time and by distance.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "tools/report/polyline.hpp"
#include "tools/report/run_record.hpp"

namespace rover::report {

// From the first moment of driving to the outcome.
struct Window {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool contains(double t_s) const { return t_s >= begin_s && t_s <= end_s; }
};

// First DRIVING to first GOAL_REACHED; where one is missing, the first or last truth.
Window drive_window(const RunRecord& run);

class TrueTrack {
 public:
  explicit TrueTrack(const std::vector<TruthSample>& truth);

  bool empty() const { return truth_.empty(); }
  // Interpolated, held at the ends. Needs a sample.
  Eigen::Isometry3d at(double t_s) const;
  // None before the first sample, after the last, and between two that are more than 0.1 s apart.
  std::optional<Eigen::Isometry3d> known_at(double t_s) const;
  Pose2 planar_at(double t_s) const;
  // Horizontal way from the first sample. Steps below 2 cm do not add up: a rover that shakes does not drive.
  double distance_m(double t_s) const;

 private:
  std::vector<TruthSample> truth_;
  std::vector<double> distance_m_;
};

// Newest sample not after t; null where there is none. Samples have t_s, in order.
template <class Sample>
const Sample* newest(const std::vector<Sample>& samples, double t_s) {
  auto it = std::upper_bound(samples.begin(), samples.end(), t_s,
                             [](double t, const Sample& sample) { return t < sample.t_s; });
  return it == samples.begin() ? nullptr : &*std::prev(it);
}

Pose2 compose(const Pose2& a, const Pose2& b);
Pose2 inverse(const Pose2& pose);
Eigen::Vector2d transform(const Pose2& pose, const Eigen::Vector2d& p);

// Planar transform that puts the odometry's track on the truth at the window's begin.
Pose2 start_alignment(const RunRecord& run, const TrueTrack& truth, const Window& window);

struct DriftSample {
  double t_s = 0.0;
  double distance_m = 0.0;
  double error_x_m = 0.0;  // map axes, estimate minus truth
  double error_y_m = 0.0;
};
// Error of T_odom_body with its start aligned, at each POSE in the window.
std::vector<DriftSample> odometry_drift(const RunRecord& run, const TrueTrack& truth, const Window& window);

// The rover's place in map by SLAM's own T_map_odom, put on the truth at the first of its poses in the window.
struct SlamTrack {
  std::vector<DriftSample> drift;  // at each SLAM_POSE
  Points line;                     // map, at each POSE from the first SLAM_POSE on
};
SlamTrack slam_track(const RunRecord& run, const TrueTrack& truth, const Window& window);

}  // namespace rover::report
