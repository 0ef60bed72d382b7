// Error of a match that its likelihood does not contain: a constant bias in the rover's axes (the camera's calibration
// moves points by the square of their range), and a larger scatter (the errors of neighbouring points are correlated).
// Both are estimated while odometry knows the pose.
#pragma once

#include <Eigen/Core>

#include "common/core/frames.hpp"

namespace rover::slam {

struct MatchErrorConfig {
  double bias_sigma_m = 0.02;     // along x or y, before the first match
  double bias_m_rtm = 0.001;      // random walk, standard deviation after 1 m
  double scatter_matches = 20.0;  // that the scatter is averaged over
};

class MatchError {
 public:
  struct State {
    Pose2 bias;                     // yaw is 0
    double bias_variance_m2 = 0.0;  // along x or y
    double scatter = 1.0;
  };
  explicit MatchError(const MatchErrorConfig& config);

  // Where a cloud fits best, seen from the rover's pose.
  const Pose2& bias() const { return state_.bias; }
  // Variance of matches over that of their likelihood, at least 1.
  double scatter() const { return state_.scatter; }

  void predict(double distance_m);
  // `fit_m`: from the predicted pose to the best fit, `covariance_m2`: by the likelihood; both in the rover's axes.
  // `pose_sigma_m`: of the predicted pose.
  void update(const Eigen::Vector2d& fit_m, const Eigen::Matrix2d& covariance_m2, double pose_sigma_m);

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  MatchErrorConfig config_;
  State state_;
};

}  // namespace rover::slam
