// Inputs of localization and their validation.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string_view>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::loc {

inline constexpr double kMaxWheelRateRadps = 50.0;

// Increments over the interval that ends at utime, in body axes.
struct ImuSample {
  Utime utime = kNever;
  double dt_s = 0.0;
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();  // of specific force
  double fog_delta_yaw_rad = 0.0;                                // NaN without the fibre-optic gyro
  bool healthy = true;                                           // self-test of the unit
};

// Wheels FL FR ML MR RL RR, steering FL FR RL RR.
struct WheelSample {
  Utime utime = kNever;
  std::array<double, 6> drive_angle_rad{};
  std::array<double, 6> drive_rate_radps{};
  std::array<double, 4> steer_angle_rad{};
  bool healthy = true;
};

struct WheelCommand {
  Utime utime = kNever;
  Utime valid_until_utime = kNever;
  std::array<double, 6> drive_rate_radps{};
};

enum class VisualStatus { kOk, kDegraded, kLost };

// Motion of the body between two exposures, by visual odometry.
struct VisualMotion {
  Utime utime = kNever;
  Utime previous_utime = kNever;
  Utime keyframe_utime = kNever;
  Eigen::Isometry3d T_prev_cur = nan_pose();
  Matrix6d cov = nan_cov();  // of the alignment with the keyframe: position, rotation; previous body axes
  VisualStatus status = VisualStatus::kLost;
};

// Pose of the body in map, commanded by the ground.
struct StartPose {
  Eigen::Vector3d position_map_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  double sigma_m = 0.0;  // of x and y
  double sigma_yaw_rad = 0.0;
};

// Measurement of map -> odom: SLAM_POSE or CORRECTION.
struct MapMeasurement {
  Utime utime = kNever;
  Pose2 T_map_odom;
  Eigen::Matrix3d cov = Eigen::Matrix3d::Constant(kNaN);  // of the body in map: x, y, yaw
  bool position_observable = true;                        // x and y; a match of SLAM may know only one direction
};

// Empty text if the input is valid, otherwise what is wrong with it.
std::string_view validation_error(const ImuSample& sample);
std::string_view validation_error(const WheelSample& sample);
std::string_view validation_error(const WheelCommand& command);
std::string_view validation_error(const VisualMotion& motion, double max_speed_mps);
std::string_view validation_error(const StartPose& start);
std::string_view validation_error(const MapMeasurement& measurement);

}  // namespace rover::loc
