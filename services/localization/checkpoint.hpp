// State that localization needs to continue after a restart of its process.
//
// Starts anew, because the rover may have stopped, turned or been moved meanwhile: the slip window, the visual velocity
// and the standstill timers. Motion records and poses before the restart are gone, so every visual motion and map
// measurement from before it is rejected, and the time of the newest correction is not needed. What was pending of
// SLAM's motions is lost, and so is its motion up to the next SLAM_POSE.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "localization/filter.hpp"

namespace rover::loc {

struct Checkpoint {
  Utime utime = kNever;
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
  bool map_known = false;
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  ErrorCov P = ErrorCov::Zero();
  double gravity_mps2 = 0.0;
  double travelled_m = 0.0;
  Utime newest_visual_utime = kNever;       // of the newest visual motion fused
  std::array<double, 6> drive_angle_rad{};  // NaN without an encoder reading
  double traction = 1.0;                    // the ground is still the same: scales the wheel distance of the gap
  double mean_traction = 1.0;
  double side_slip = 0.0;
  Eigen::Vector3d smoothing_offset_m = Eigen::Vector3d::Zero();  // published pose minus T_odom_body
  Eigen::Vector3d smoothing_offset_rad = Eigen::Vector3d::Zero();
  int consecutive_conflicts = 0;  // a suspect gyro stays suspect
  double conflict_span_s = 0.0;
  // A restart must not extend the time without IMU or the distance without visual odometry.
  Utime imu_healthy_utime = kNever;
  double dead_reckoned_m = 0.0;
};

std::vector<std::uint8_t> to_bytes(const Checkpoint& checkpoint);
// Empty if the bytes are of another version or the state is invalid.
std::optional<Checkpoint> from_bytes(const std::vector<std::uint8_t>& bytes);

}  // namespace rover::loc
