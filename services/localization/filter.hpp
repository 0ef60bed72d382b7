// Error-state Kalman filter of the rover's pose in odom (Sola, "Quaternion kinematics for the error-state Kalman
// filter", 2017). Attitude errors are global: rotations in odom axes, applied on the left.
//
// State: position, attitude, gyro bias, and of visual odometry the scale error and the rotation of the camera's
// mounting. The last two are consider parameters (Schmidt-Kalman): they come from calibration, and no onboard sensor
// separates them from slip.
// Prediction (propagate) uses gyro and wheels. The visual update (fuse_visual) replaces the wheels and combines the
// rotations of gyro and images by their covariances.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "common/core/frames.hpp"
#include "localization/motion_history.hpp"

namespace rover::loc {

struct FilterConfig {
  double gyro_noise_rad_rts = 6e-5;                // angle random walk; STIM300: 0.15 deg/sqrt(h) = 4.4e-5
  double fog_noise_rad_rts = 7e-6;                 // fibre-optic gyro (z); KVH DSP-1760: 3.5e-6, plus misalignment
  double no_fog_noise_rad_rts = 3e-4;              // z without the fibre-optic gyro: MEMS gyro of unknown bias
  double gyro_bias_sigma_radps = 2.5e-5;           // after static alignment
  double fog_bias_sigma_radps = 4e-6;              // after static alignment
  double gyro_bias_walk_radps_rts = 1e-7;          // STIM300: 0.3 deg/h over 600 s
  double fog_bias_walk_radps_rts = 3e-8;           // KVH DSP-1760: 0.05 deg/h = 1.4e-8
  double force_noise_mps2_rthz = 0.10;             // accelerations of the drive, including bumps, averaged over 1 s
  double wheel_noise_m_rtm = 0.025;                // random error of wheel odometry, standard deviation after 1 m
  double slip_sigma = 0.1;                         // of the slip since the newest visual motion: an error per metre
  double no_gyro_noise_rad_rts = 0.05;             // attitude without gyro, from wheels alone
  double visual_scale_sigma = 0.0012;              // residual of a calibration error of 0.2 px
  double mounting_sigma_rad = to_rad(0.05);        // of the camera on the body, each axis
  double visual_floor_m = 1e-4;                    // minimum position sigma of a visual motion
  double max_rotation_conflict_sigma = 6.0;        // innovation gate between gyro and images
  double max_rotation_conflict_rad = to_rad(0.6);  // smaller differences always pass the gate
};

constexpr int kPosition = 0;
constexpr int kAttitude = 3;
constexpr int kBias = 6;
constexpr int kScale = 9;
constexpr int kMounting = 10;  // body axes
constexpr int kErrorSize = 13;
using ErrorCov = Eigen::Matrix<double, kErrorSize, kErrorSize>;

struct FilterState {
  Utime utime = kNever;
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  ErrorCov P = ErrorCov::Zero();
  double dead_reckoned_m = 0.0;  // distance since visual odometry or SLAM measured the motion
  // Variance that random errors have added to x or y, and to yaw, since the start: P without the errors of start pose,
  // biases, scale and mounting, which are constant over a drive.
  double noise_m2 = 0.0;
  double noise_rad2 = 0.0;
};

// Relative motion from visual odometry.
struct VisualInterval {
  Utime from = kNever;
  Utime to = kNever;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d cov = Matrix6d::Zero();  // position, rotation; axes of the body at `from`
};

class Filter {
 public:
  // origin_height_m: of the body origin above the ground.
  Filter(const FilterConfig& config, double origin_height_m) : config_(config), origin_height_m_(origin_height_m) {}

  void set_gravity(double gravity_mps2) { gravity_mps2_ = gravity_mps2; }
  double gravity() const { return gravity_mps2_; }

  FilterState initial_state(Utime utime, const Eigen::Matrix3d& R_odom_body, const Eigen::Vector3d& gyro_bias) const;

  // `ground_m`: motion of the point of the body on the ground below its origin, body axes. Wheels measure it: on rocks
  // the body turns about it, and the origin, 0.6 m above, moves by centimetres that no wheel rolls.
  FilterState propagate(FilterState state, const MotionRecord& record, const Eigen::Vector2d& ground_m) const;

  // `records`: IMU and wheels over the same interval. Empty if gyro and images contradict each other.
  std::optional<FilterState> fuse_visual(const FilterState& at_from, const std::vector<MotionRecord>& records,
                                         const VisualInterval& visual) const;

 private:
  Eigen::Vector3d gyro_variance(const MotionRecord& record) const;
  Eigen::Vector3d rotation_variance(const MotionRecord& record) const;
  void add_bias_random_walk(FilterState& state, double dt_s) const;
  void update_tilt(FilterState& state, const Eigen::Vector3d& mean_force_odom, double duration_s) const;
  void update_gyro_bias(FilterState& state, const MotionRecord& record) const;

  FilterConfig config_;
  double origin_height_m_;
  double gravity_mps2_ = 0.0;
};

}  // namespace rover::loc
