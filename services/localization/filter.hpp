// Error-state Kalman filter of the rover's pose in odom (Sola, "Quaternion kinematics for the error-state Kalman
// filter", 2017; errors in odom axes, applied on the left).
//
//   state   position, attitude, gyro bias, and the scale error of visual odometry as a parameter that is considered but
//           never estimated (Schmidt): calibration makes it, nothing on board can tell it from slip
//   between two exposures  gyro and wheels carry the state on (advance)
//   over them              the visual motion replaces the wheels; where gyro and images disagree in rotation, the
//                          difference is shared by their covariances, and the position follows through the covariance
//                          of the visual motion (fuse_visual)
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "common/core/frames.hpp"
#include "localization/motion_history.hpp"

namespace rover::loc {

struct FilterConfig {
  double gyro_noise_rad_rts = 6e-5;       // angle random walk; STIM300: 0.15 deg/sqrt(h) = 4.4e-5
  double fog_noise_rad_rts = 7e-6;        // of the fibre-optic gyro about z; KVH DSP-1760: 3.5e-6, misalignment
  double no_fog_noise_rad_rts = 3e-4;     // of the gyro about z, its bias unknown, in place of a silent fibre-optic one
  double gyro_bias_sigma_radps = 2.5e-5;  // after levelling
  double fog_bias_sigma_radps = 4e-6;
  double gyro_bias_walk_radps_rts = 1e-7;  // STIM300: 0.3 deg/h over 600 s
  double fog_bias_walk_radps_rts = 3e-8;   // KVH DSP-1760: 0.05 deg/h = 1.4e-8
  double force_noise_mps2_rthz = 0.10;     // the rover's own acceleration, bumps included, averaged over 1 s
  double wheel_noise_m_rtm = 0.15;         // standard deviation after 1 m on wheels alone
  double blind_rate_radps = 0.05;          // per sqrt(s): attitude without a gyro, on wheels alone
  // Visual odometry knows its noise, not the error of calibration, which follows the same weak directions: with 0.2 px
  // of it, motions over rendered ground are off by 3 to 6 of its sigma.
  double visual_cov_factor = 10.0;
  double visual_scale_sigma = 0.003;               // what is left of a calibration error of 0.2 px
  double visual_floor_m = 1e-4;                    // never trust one visual motion better than this
  double max_rotation_conflict_sigma = 6.0;        // gyro against images
  double max_rotation_conflict_rad = to_rad(0.6);  // smaller conflicts are never one
};

constexpr int kPosition = 0;
constexpr int kAttitude = 3;
constexpr int kBias = 6;
constexpr int kScale = 9;
constexpr int kErrorSize = 10;
using ErrorCov = Eigen::Matrix<double, kErrorSize, kErrorSize>;

struct FilterState {
  Utime utime = kNever;
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  ErrorCov P = ErrorCov::Zero();
};

// Motion over an interval as images saw it.
struct VisualInterval {
  Utime from = kNever;
  Utime to = kNever;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d cov = Matrix6d::Zero();  // position, rotation; axes of the body at `from`
};

class Filter {
 public:
  explicit Filter(const FilterConfig& config) : config_(config) {}

  void set_gravity(double gravity_mps2) { gravity_mps2_ = gravity_mps2; }
  double gravity() const { return gravity_mps2_; }

  FilterState start(Utime utime, const Eigen::Matrix3d& R_odom_body, const Eigen::Vector3d& gyro_bias) const;

  // `grip`: metres gained per metre rolled.
  FilterState advance(FilterState state, const MotionRecord& record, double grip) const;

  // `records`: what IMU and wheels measured over the interval. Nothing where gyro and images contradict each other.
  std::optional<FilterState> fuse_visual(const FilterState& at_from, const std::vector<MotionRecord>& records,
                                         const VisualInterval& visual) const;

 private:
  Eigen::Vector3d gyro_variance(const MotionRecord& record) const;
  Eigen::Vector3d angle_variance(const MotionRecord& record) const;
  void wander(FilterState& state, double dt_s) const;
  void level(FilterState& state, const Eigen::Vector3d& mean_force_odom, double duration_s) const;
  void rest(FilterState& state, const MotionRecord& record) const;

  FilterConfig config_;
  double gravity_mps2_ = 0.0;
};

}  // namespace rover::loc
