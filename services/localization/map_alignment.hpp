// T_map_odom: set by the start pose, moved by absolute corrections at once and by SLAM at a bounded rate. Planar: both
// frames are level. The pose in odom never changes by it.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "common/core/frames.hpp"
#include "localization/filter.hpp"
#include "localization/inputs.hpp"

namespace rover::loc {

struct MapAlignmentConfig {
  double gate_chi2 = 16.3;  // 99.9 % of three degrees of freedom
  // By which the pose may be further off than it believes when a correction comes: what global_localization looks for
  // (a third of its window), so that it finds nothing that is refused here.
  double widened_m = 4.0;
  double widened_rad = to_rad(4.0);
  double slam_rate_mps = 0.02;  // how fast SLAM may move map against odom
  double slam_rate_radps = to_rad(0.3);
};

// A measurement that was taken: gain and noise for the filter's covariances.
using PlanarCov = Eigen::Matrix3d;

class MapAlignment {
 public:
  explicit MapAlignment(const MapAlignmentConfig& config) : config_(config) {}

  bool known() const { return known_; }
  const Eigen::Isometry3d& T_map_odom() const { return T_map_odom_; }

  void set_start(const StartPose& start, const Eigen::Isometry3d& T_odom_body);
  void restore(const Eigen::Isometry3d& T_map_odom);

  // Whether the measurement lies where its covariance and that of the pose allow. `T_odom_body`: at its time; `P`: of
  // the newest state.
  bool consistent(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P) const;
  // Of a pose that turned out to be further off than it believed.
  ErrorCov widened(ErrorCov P) const;
  // At once. Empty text where taken.
  std::string_view take_correction(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P);
  // By and by, in step().
  std::string_view take_slam(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P);
  void step(double dt_s, const Eigen::Isometry3d& T_odom_body);

  // Covariance of the pose after a measurement of x, y, yaw in map with noise `R`; the other errors are not estimated
  // by it (Schmidt), so the pose in odom stays as it is.
  ErrorCov updated(const ErrorCov& P, const PlanarCov& R_map) const;

 private:
  // Position and yaw of the body in map, wanted minus now.
  Eigen::Vector3d innovation(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body) const;
  Eigen::Matrix3d planar_cov(const ErrorCov& P) const;
  // Moves map against odom so that the body at T_odom_body moves by (x, y, yaw) in map.
  void shift(const Eigen::Vector3d& delta, const Eigen::Isometry3d& T_odom_body);
  Eigen::Vector3d gained(const Eigen::Vector3d& innovation, const ErrorCov& P, const PlanarCov& R) const;

  MapAlignmentConfig config_;
  bool known_ = false;
  Eigen::Isometry3d T_map_odom_ = Eigen::Isometry3d::Identity();
  Utime newest_correction_ = kNever;
  Eigen::Vector3d pending_ = Eigen::Vector3d::Zero();  // what SLAM still has to move
};

}  // namespace rover::loc
