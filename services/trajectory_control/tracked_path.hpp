// A path made ready for following: smooth legs between point turns, each sampled with heading, curvature and the
// speed that curvature, steering rate and the stop at its end allow.
//
// Where the polyline bends by more than a threshold within a short way (no arc of the least radius follows that) the
// path is cut: the rover stops there and turns on the spot. Each leg is followed along the smoothest curve near it,
// whose curvature the slow steering can follow; the cross track is measured against the leg itself.
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
  std::vector<Eigen::Vector2d> points;  // in odom
  bool backwards = false;               // the rover drives it stern first
};

struct TrackedPathConfig {
  double sample_m = 0.05;
  SmootherConfig smoother;
  double kink_rad = 0.698;  // 40 deg between chords of half a metre before and behind: point turn
  double kink_chord_m = 0.30;
  double max_curvature_per_m = 1.0;
  double max_curvature_rate = 0.185;  // [1/(m s)], of the steering motors
  double cruise_speed_mps = 0.2;
  double least_speed_mps = 0.06;  // curvature changes do not slow the rover below it
  double max_wheel_speed_mps = 0.29;
  double outer_wheel_x_m = 0.75;
  double outer_wheel_y_m = 0.41;
  double deceleration_mps2 = 0.10;
};

struct PathSample {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();      // on the smooth curve
  Eigen::Vector2d given = Eigen::Vector2d::Zero();  // on the path
  double yaw_rad = 0.0;
  double curvature_per_m = 0.0;
  double speed_mps = 0.0;
};

// Where the rover is with respect to a leg.
struct Projection {
  double s_m = 0.0;            // along the leg, clamped to it
  double beyond_m = 0.0;       // past the end (positive) or before the start (negative)
  double cross_track_m = 0.0;  // positive: rover left of the curve
  double yaw_rad = 0.0;        // of the curve
  double distance_m = 0.0;
};

class Leg {
 public:
  Leg(std::vector<Eigen::Vector2d> samples, double step_m, double start_m, const TrackedPathConfig& config);

  double length_m() const { return step_m_ * static_cast<double>(samples_.size() - 1); }
  double start_m() const { return start_m_; }  // along the whole path
  const std::vector<PathSample>& samples() const { return samples_; }
  PathSample at(double s_m) const;
  // Closest point of the smooth curve with s in [from, to].
  Projection project(const Eigen::Vector2d& p, double from_m, double to_m) const;
  // Signed distance from the path as it was given, near s.
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
};

struct Place {
  size_t leg = 0;
  double s_m = 0.0;
};

class TrackedPath {
 public:
  // Nothing where the input is not a path: fewer than two distinct points, a number not finite, no corridor.
  static std::optional<TrackedPath> build(const PathInput& input, const TrackedPathConfig& config);

  std::int64_t id() const { return id_; }
  double corridor_half_width_m() const { return corridor_half_width_m_; }
  double length_m() const { return legs_.back().start_m() + legs_.back().length_m(); }
  const std::vector<Leg>& legs() const { return legs_; }
  // The sample closest to the pose on the whole path; of parts that pass by well inside the corridor, the one that runs
  // the rover's way. The heading never leads away from the closest place of a part: a path that begins with a point
  // turn begins where the rover is.
  Place locate(const Pose2& pose) const;

 private:
  TrackedPath() = default;
  std::int64_t id_ = -1;
  double corridor_half_width_m_ = 0.0;
  std::vector<Leg> legs_;
};

}  // namespace rover::control
