// Reference trajectory for path following. The polyline is split where the direction of motion changes, and at sharp
// corners (no arc of the minimum radius can follow them); the rover turns on the spot there. Each segment is a smoothed
// curve with heading, curvature and a speed profile (curvature, steering rate, stop at the end). The cross track is
// measured against the unsmoothed path.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/frames.hpp"
#include "trajectory_control/path_smoother.hpp"

namespace rover::control {

struct PathInput {
  std::int64_t id = -1;
  double corridor_half_width_m = 0.0;
  std::vector<Eigen::Vector2d> points;  // odom frame
  std::vector<bool> reverse;            // motion from each point on; points without a value: forward
};

struct TrackedPathConfig {
  double sample_m = 0.05;
  SmootherConfig smoother;
  double corner_rad = to_rad(40.0);  // between the chords before and after a point: point turn
  double corner_chord_m = 0.30;
  double max_curvature_per_m = 1.0;
  double max_curvature_rate = 0.185;  // [1/(m s)], limit of the steering motors
  double cruise_speed_mps = 0.2;
  double min_speed_mps = 0.10;  // lower bound for slow-down due to curvature changes
  double max_wheel_speed_mps = 0.29;
  double outer_wheel_x_m = 0.75;
  double outer_wheel_y_m = 0.41;
  double deceleration_mps2 = 0.10;
};

struct PathSample {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();       // on the smoothed curve
  Eigen::Vector2d p_path = Eigen::Vector2d::Zero();  // on the unsmoothed path
  double yaw_rad = 0.0;
  double curvature_per_m = 0.0;
  double speed_mps = 0.0;
};

// Projection of the rover position onto a segment (Frenet frame).
struct Projection {
  double s_m = 0.0;            // arc length, clamped to the segment
  double beyond_m = 0.0;       // distance past the end (positive) or before the start (negative)
  double cross_track_m = 0.0;  // positive: rover is left of the curve
  double yaw_rad = 0.0;        // heading of the curve
  double distance_m = 0.0;
};

class PathSegment {
 public:
  PathSegment(std::vector<Eigen::Vector2d> samples, double step_m, double start_m, bool reverse,
              const TrackedPathConfig& config);

  double length_m() const { return step_m_ * static_cast<double>(samples_.size() - 1); }
  double start_m() const { return start_m_; }  // arc length of its start on the whole path
  double step_m() const { return step_m_; }
  double sample_m(size_t i) const { return start_m_ + step_m_ * static_cast<double>(i); }  // on the whole path
  bool reverse() const { return reverse_; }  // headings are those of the motion, not of the body
  const std::vector<PathSample>& samples() const { return samples_; }
  PathSample at(double s_m) const;
  // Closest point of the smoothed curve with arc length in [from_m, to_m].
  Projection project(const Eigen::Vector2d& p, double from_m, double to_m) const;
  // Signed distance to the unsmoothed path, searched around near_m.
  double cross_track_m(const Eigen::Vector2d& p, double near_m) const;

 private:
  void set_headings();
  void set_curvatures(const TrackedPathConfig& config);
  void set_speeds(const TrackedPathConfig& config);
  template <class PointOf>
  Projection project_on(const Eigen::Vector2d& p, double from_m, double to_m, PointOf point_of) const;

  std::vector<PathSample> samples_;
  double step_m_;
  double start_m_;
  bool reverse_;
};

struct PathPosition {
  size_t segment = 0;
  double s_m = 0.0;
};

class TrackedPath {
 public:
  // Returns nullopt for an invalid path: fewer than two distinct points, non-finite numbers, no corridor.
  static std::optional<TrackedPath> build(const PathInput& input, const TrackedPathConfig& config);

  std::int64_t id() const { return id_; }
  double corridor_half_width_m() const { return corridor_half_width_m_; }
  double length_m() const { return segments_.back().start_m() + segments_.back().length_m(); }
  const std::vector<PathSegment>& segments() const { return segments_; }
  // Closest sample to the pose up to the first cusp, on the part contiguous with the beginning if that is at the rover:
  // what follows may pass the same place. Of several within kCandidateFraction of the half width, the best aligned one.
  PathPosition locate(const Pose2& pose) const;

 private:
  TrackedPath() = default;
  // Between two changes of direction.
  void add_part(const std::vector<Eigen::Vector2d>& points, bool reverse, const TrackedPathConfig& config);

  std::int64_t id_ = -1;
  double corridor_half_width_m_ = 0.0;
  std::vector<PathSegment> segments_;
};

}  // namespace rover::control
