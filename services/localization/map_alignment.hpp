// T_map_odom: set by the start pose, corrected at once by global corrections and at a bounded rate by SLAM. Planar,
// because both frames are gravity-aligned. It never changes the pose in odom.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "common/core/frames.hpp"
#include "localization/filter.hpp"
#include "localization/inputs.hpp"

namespace rover::loc {

struct MapAlignmentConfig {
  double gate_chi2 = 16.3;  // 99.9 % of chi-square with three degrees of freedom
  // Sigma added to the pose's covariance if a correction fails the gate: a third of the search window of
  // global_localization, so that every match it finds passes here.
  double inflation_m = 4.0;
  double inflation_rad = to_rad(4.0);
  double slam_sigma_m = 0.005;  // error of SLAM from cloud to cloud
  double slam_sigma_rad = to_rad(0.005);
  double slam_rate_mps = 0.02;  // limit of the motion of map against odom by SLAM
  double slam_rate_radps = to_rad(0.3);
};

using PlanarCov = Eigen::Matrix3d;  // x, y, yaw

class MapAlignment {
 public:
  explicit MapAlignment(const MapAlignmentConfig& config) : config_(config) {}

  bool known() const { return known_; }
  const Eigen::Isometry3d& T_map_odom() const { return T_map_odom_; }

  void set_start(const StartPose& start, const Eigen::Isometry3d& T_odom_body);
  void restore(const Eigen::Isometry3d& T_map_odom);

  // Chi-square test of the innovation. `T_odom_body`: at the measurement's time; `P`: of the newest state.
  bool within_gate(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P) const;
  // For a pose whose covariance proved too small: along what a measurement with noise `R_map` knows better than the
  // inflation. A fix along one axis says nothing of the others.
  ErrorCov inflated(ErrorCov P, const PlanarCov& R_map) const;
  // Why a correction or SLAM pose cannot be used; empty if it can.
  std::string_view rejection(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P) const;
  // Takes effect at once. Empty text if accepted.
  std::string_view apply_correction(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P);
  // Takes effect gradually, in step(). SLAM is predicted with odometry, so only its motion of map against odom since
  // the last pose counts, weighted by the noise that odometry gained meanwhile. `odometry`: at the time of `m`.
  // False if the motion is unknown: after a restart, a correction or a new anchor of SLAM the first pose has none.
  bool add_slam_pose(const MapMeasurement& m, const FilterState& odometry);
  void step(double dt_s, const Eigen::Isometry3d& T_odom_body);

  // Covariance after a measurement of x, y, yaw in map with noise `R_map`. Other errors are consider states
  // (Schmidt), so the pose in odom stays unchanged.
  ErrorCov updated_cov(const ErrorCov& P, const PlanarCov& R_map) const;

 private:
  // Position and yaw of the body in map, measured minus estimated.
  Eigen::Vector3d innovation(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body) const;
  Eigen::Matrix3d planar_cov(const ErrorCov& P) const;
  // Moves map against odom so that the body at T_odom_body moves by (x, y, yaw) in map.
  void shift(const Eigen::Vector3d& delta, const Eigen::Isometry3d& T_odom_body);
  // Kalman gain times innovation.
  Eigen::Vector3d correction(const Eigen::Vector3d& innovation, const ErrorCov& P, const PlanarCov& R) const;

  MapAlignmentConfig config_;
  bool known_ = false;
  Eigen::Isometry3d T_map_odom_ = Eigen::Isometry3d::Identity();
  Utime newest_correction_utime_ = kNever;
  struct SlamPose {
    MapMeasurement measurement;
    double noise_m2, noise_rad2;  // of odometry until then
  };
  std::optional<SlamPose> slam_;                       // the newest, since map was last moved otherwise
  Eigen::Vector3d pending_ = Eigen::Vector3d::Zero();  // SLAM correction not yet applied
};

}  // namespace rover::loc
