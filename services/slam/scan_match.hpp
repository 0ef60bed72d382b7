// Likelihood of a cloud given the map and a rover pose, and which pose directions the terrain makes observable.
//
// The residual of a patch is its height above the map. Errors of attitude and height in odometry are a small plane,
// which is fitted per pose (with a prior) and removed. Geman-McClure kernel: outliers have a bounded cost.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/match_surface.hpp"
#include "slam/patches.hpp"

namespace rover::slam {

struct MatchConfig {
  int max_patches = 2500;             // subsampled evenly
  double max_range_m = 5.0;           // farther, depth noise truncated at the sensor's range biases heights upwards
  int min_patches = 150;              // on the map; fewer: no match
  double model_sigma_m = 0.006;       // unmodelled height error
  double horizontal_sigma_m = 0.015;  // of the grid; times the slope: a height error
  double kernel_sigma = 3.0;
  double temper = 2.0;           // log-likelihood factor: patch errors are correlated, variances conservative
  double height_sigma_m = 0.02;  // prior of the fitted plane
  double tilt_sigma_rad = to_rad(0.115);
  double hessian_step_m = 0.05;         // step of the numerical Hessian
  double unobservable_sigma_m = 0.012;  // a direction with a larger standard deviation is unobservable
  double yaw_lever_m = 3.0;             // scales yaw to metres, to compare it with x and y
};

struct MatchFit {
  double log_likelihood = 0.0;
  double inlier_ratio = 0.0;                        // inliers among the points on the map
  Eigen::Vector3f plane = Eigen::Vector3f::Zero();  // cloud minus map: height [m], slopes along x and y [1]
};

// x, y, yaw of the rover in the map's frame.
struct MatchInformation {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();      // [1/m^2, 1/m, 1/rad^2]
  Eigen::Matrix3d observable = Eigen::Matrix3d::Zero();  // projector onto the observable directions
  int observable_directions = 0;                         // 0 .. 3
  double weakest_information = 0.0;  // 1 / standard deviation [1/m] of the weakest, yaw at yaw_lever_m; 0: none
  Eigen::Vector3d to_best = Eigen::Vector3d::Zero();  // from the pose to the best fit [m, m, rad]; a Newton step
};

class ScanMatcher {
 public:
  explicit ScanMatcher(const MatchConfig& config) : config_(config) {}

  // Patches in the rover's axes. Weights are those at `reference`, the approximate pose. `surface` must outlive
  // all later calls.
  void prepare(const std::vector<Patch>& patches, const MatchSurface& surface, const Pose2& reference);
  int matched_points() const { return static_cast<int>(points_.size()); }
  bool has_enough_points() const { return matched_points() >= config_.min_patches; }

  MatchFit fit(const Pose2& pose, int iterations = 1) const;
  MatchInformation information(const Pose2& pose) const;

 private:
  struct Point {
    float x, y, z;
    float weight;        // 1 / variance
    float off_map_cost;  // cost if off the map: that at the reference, so that the map's border has no gradient
  };
  // Transforms rover coordinates to surface cells.
  struct ToCells {
    float cos, sin, x, y;
    ToCells(const MatchSurface& surface, const Pose2& pose);
    float u(const Point& p) const { return x + cos * p.x - sin * p.y; }
    float v(const Point& p) const { return y + sin * p.x + cos * p.y; }
  };
  // Of the negative log-likelihood.
  void differentiate(const Pose2& pose, Eigen::Vector3d& gradient, Eigen::Matrix3d& hessian) const;
  void compute_residuals(const Pose2& pose) const;
  Eigen::Vector3f refit_plane(const Eigen::Vector3f& from) const;
  MatchFit evaluate(const Eigen::Vector3f& plane) const;
  float plane_residual(size_t i, const Eigen::Vector3f& plane) const {
    return residual_[i] - plane.x() - plane.y() * points_[i].x - plane.z() * points_[i].y;
  }

  MatchConfig config_;
  const MatchSurface* surface_ = nullptr;
  std::vector<Point> points_;
  Eigen::Vector3f start_plane_ = Eigen::Vector3f::Zero();
  mutable std::vector<float> residual_;  // of each point at the current pose; NaN: off the map
};

}  // namespace rover::slam
