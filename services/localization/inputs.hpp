// What localization takes in, and the checks each input must pass first.
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
  double fog_delta_yaw_rad = 0.0;                                // NaN: the fibre-optic gyro is silent
  bool healthy = true;                                           // as the unit itself says
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

// Motion of the body between two exposures.
struct VisualMotion {
  Utime utime = kNever;
  Utime previous_utime = kNever;
  Utime keyframe_utime = kNever;
  Eigen::Isometry3d T_prev_cur = nan_pose();
  Matrix6d cov = nan_cov();  // of the end's alignment with the keyframe: position, rotation; previous body's axes
  VisualStatus status = VisualStatus::kLost;
};

// T_map_body on ground command; the heading is the rover's in map.
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
};

// Each gives an empty text where the input is sound, else what is wrong with it.
std::string_view flaw_of(const ImuSample& sample);
std::string_view flaw_of(const WheelSample& sample);
std::string_view flaw_of(const WheelCommand& command);
std::string_view flaw_of(const VisualMotion& motion, double max_speed_mps);
std::string_view flaw_of(const StartPose& start);
std::string_view flaw_of(const MapMeasurement& measurement);

}  // namespace rover::loc
