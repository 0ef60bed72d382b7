#include "rover_simulator/convert.hpp"

#include <algorithm>

#include "common/bus/convert.hpp"

namespace rover {
namespace {

void copy3(const Eigen::Vector3d& from, double to[3]) {
  std::copy(from.data(), from.data() + 3, to);
}

template <size_t N>
void copy(const std::array<double, N>& from, double (&to)[N]) {
  std::copy(from.begin(), from.end(), to);
}

}  // namespace

imu_t imu_message(const ImuSample& sample) {
  imu_t message{};
  message.dt_s = sample.dt_s;
  copy3(sample.delta_angle_rad, message.delta_angle_rad);
  copy3(sample.delta_velocity_mps, message.delta_velocity_mps);
  message.fog_delta_yaw_rad = sample.fog_delta_yaw_rad;
  message.status = imu_t::OK;
  return message;
}

wheel_state_t wheel_state_message(const WheelSample& sample, bool command_expired) {
  wheel_state_t message{};
  copy(sample.drive_angle_rad, message.drive_angle_rad);
  copy(sample.drive_rate_radps, message.drive_rate_radps);
  copy(sample.drive_current_a, message.drive_current_a);
  copy(sample.steer_angle_rad, message.steer_angle_rad);
  copy(sample.steer_current_a, message.steer_current_a);
  copy(sample.bogie_angle_rad, message.bogie_angle_rad);
  message.status = command_expired ? wheel_state_t::COMMAND_EXPIRED : wheel_state_t::OK;
  return message;
}

truth_t truth_message(const VehicleTruth& truth) {
  truth_t message{};
  pose_to(truth.T_map_body, message.position_map_body_m, message.quat_map_body_wxyz);
  copy3(truth.velocity_map_mps, message.velocity_map_mps);
  copy(truth.wheel_slip, message.wheel_slip);
  copy(truth.wheel_sinkage_m, message.wheel_sinkage_m);
  for (size_t wheel = 0; wheel < truth.wheel_soil.size(); ++wheel)
    message.wheel_soil[wheel] = static_cast<std::int8_t>(truth.wheel_soil[wheel]);
  message.clearance_m = truth.clearance_m;
  message.climb_m = truth.climb_m;
  message.collision = static_cast<std::int8_t>(truth.collision);
  return message;
}

image_t image_message(const GrayImage& image, double exposure_s) {
  image_t message{};
  image_to(image, message);
  message.exposure_s = static_cast<float>(exposure_s);
  return message;
}

ptu_state_t ptu_state_message(const PanTiltState& state) {
  ptu_state_t message{};
  message.pan_rad = state.pan_rad;
  message.tilt_rad = state.tilt_rad;
  message.moving = state.moving ? 1 : 0;
  return message;
}

PanTiltCommand pan_tilt_command_from(const ptu_command_t& message) {
  return {message.pan_rad, message.tilt_rad, message.take_image != 0};
}

WheelCommand wheel_command_from(const wheel_command_t& message) {
  WheelCommand command;
  std::copy(std::begin(message.drive_rate_radps), std::end(message.drive_rate_radps), command.drive_rate_radps.begin());
  std::copy(std::begin(message.steer_angle_rad), std::end(message.steer_angle_rad), command.steer_angle_rad.begin());
  return command;
}

}  // namespace rover
