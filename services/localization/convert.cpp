#include "localization/convert.hpp"

#include <algorithm>

#include "common/bus/convert.hpp"

namespace rover::loc {
namespace {

template <class Message>
MapMeasurement planar_from(const Message& message) {
  MapMeasurement m;
  m.utime = message.header.utime;
  m.T_map_odom = {message.x_m, message.y_m, message.yaw_rad};
  m.cov = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.covariance);
  return m;
}

int8_t status_code(PoseStatus status) {
  switch (status) {
    case PoseStatus::kOk:
      return pose_t::OK;
    case PoseStatus::kDegraded:
      return pose_t::DEGRADED;
    case PoseStatus::kLost:
      return pose_t::LOST;
    case PoseStatus::kUninitialised:
      break;
  }
  return pose_t::UNINITIALISED;
}

}  // namespace

ImuSample imu_from(const imu_t& message) {
  ImuSample s;
  s.utime = message.header.utime;
  s.dt_s = message.dt_s;
  s.delta_angle_rad = Eigen::Vector3d(message.delta_angle_rad);
  s.delta_velocity_mps = Eigen::Vector3d(message.delta_velocity_mps);
  s.fog_delta_yaw_rad = message.fog_delta_yaw_rad;
  s.healthy = message.status == imu_t::OK;
  return s;
}

WheelSample wheels_from(const wheel_state_t& message) {
  WheelSample s;
  s.utime = message.header.utime;
  std::copy_n(message.drive_angle_rad, 6, s.drive_angle_rad.begin());
  std::copy_n(message.drive_rate_radps, 6, s.drive_rate_radps.begin());
  std::copy_n(message.steer_angle_rad, 4, s.steer_angle_rad.begin());
  // COMMAND_EXPIRED means that the wheels brake; the encoders still work.
  s.healthy = message.status != wheel_state_t::FAULT;
  return s;
}

WheelCommand wheel_command_from(const wheel_command_t& message) {
  WheelCommand c;
  c.utime = message.header.utime;
  c.valid_until_utime = message.valid_until_utime;
  std::copy_n(message.drive_rate_radps, 6, c.drive_rate_radps.begin());
  return c;
}

VisualMotion visual_from(const vo_motion_t& message) {
  VisualMotion m;
  m.utime = message.header.utime;
  m.previous_utime = message.previous_utime;
  m.keyframe_utime = message.keyframe_utime;
  m.T_prev_cur = pose_from(message.position_m, message.quat_wxyz);
  m.cov = matrix6_from(message.covariance);
  if (message.status == vo_motion_t::OK) m.status = VisualStatus::kOk;
  if (message.status == vo_motion_t::DEGRADED) m.status = VisualStatus::kDegraded;
  return m;
}

StartPose start_pose_from(const ground_command_t& message) {
  return {Eigen::Vector3d(message.position_map_m), message.yaw_rad, message.sigma_m, message.sigma_yaw_rad};
}

MapMeasurement measurement_from(const slam_pose_t& message) {
  MapMeasurement m = planar_from(message);
  m.position_observable = message.information > 0.0;
  return m;
}
MapMeasurement measurement_from(const correction_t& message) {
  return planar_from(message);
}

void pose_to(const PoseEstimate& pose, pose_t& message) {
  message.status = status_code(pose.status);
  rover::pose_to(pose.T_odom_body, message.position_odom_body_m, message.quat_odom_body_wxyz);
  rover::pose_to(pose.T_map_odom, message.position_map_odom_m, message.quat_map_odom_wxyz);
  matrix6_to(pose.cov, message.covariance);
  std::copy_n(pose.velocity_body_mps.data(), 3, message.velocity_body_mps);
  std::copy_n(pose.rate_body_radps.data(), 3, message.rate_body_radps);
  message.travelled_m = pose.travelled_m;
  message.last_vo_utime = pose.last_vo_utime;
}

void slip_to(const Slip& slip, slip_t& message) {
  message.window_s = slip.window_s;
  message.commanded_mps = slip.commanded_mps;
  message.wheel_mps = slip.wheel_mps;
  message.visual_mps = slip.visual_mps;
  message.slip_ratio = slip.slip_ratio;
  message.valid = slip.valid ? 1 : 0;
}

}  // namespace rover::loc
