#include "rover_simulator/world_faults.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/frames.hpp"

namespace rover {
namespace {

bool is_active(const injection_t& injection, Utime now) {
  return now >= injection.from_utime && now <= injection.until_utime;
}

void apply_camera_fault(const injection_t& injection, CameraFault& camera) {
  const int pixels = static_cast<int>(std::lround(injection.amount));
  if (injection.fault == "camera_blind") camera.blind = true;
  if (injection.fault == "camera_frozen") camera.frozen = true;
  if (injection.fault == "camera_rows") camera.shift_rows = pixels;
  if (injection.fault == "camera_columns") camera.shift_columns = pixels;
  if (injection.fault == "camera_roll") camera.roll_deg = injection.amount;
  if (injection.fault == "camera_fog") camera.fog = injection.amount;
  if (injection.fault == "camera_dirt") camera.dirt = injection.amount;
  if (injection.fault == "camera_glare") camera.glare = injection.amount;
}

void apply_sensor_fault(const injection_t& injection, SensorFaults& sensors) {
  if (injection.fault.rfind("camera_", 0) == 0) {
    static const std::array<std::string, 4> kCameraNames = {"left", "right", "navcam_left", "navcam_right"};
    for (size_t i = 0; i < kCameraNames.size(); ++i)
      if (injection.target == kCameraNames[i] || injection.target == (i < 2 ? "both" : "navcam"))
        apply_camera_fault(injection, sensors.camera[i]);
  }
  if (injection.fault == "imu_dead") sensors.imu_dead = true;
  if (injection.fault == "gyro_bias") sensors.yaw_bias_radps += injection.amount;
  if (injection.fault == "accel_bias") sensors.forward_bias_mps2 += injection.amount;
  if (injection.fault == "encoder_stuck") sensors.encoder_stuck.at(std::stoul(injection.target)) = true;
}

// The tilt ramps up and down at this rate, like driving onto and off a slope.
double tilt_rad(const injection_t& injection, Utime now) {
  constexpr double kRateRadps = to_rad(15.0);
  const double max_rad = std::abs(to_rad(injection.amount));
  const double rising_rad = kRateRadps * to_seconds(now - injection.from_utime);
  const double falling_rad = max_rad - kRateRadps * to_seconds(now - injection.until_utime);
  return std::copysign(std::clamp(std::min(rising_rad, falling_rad), 0.0, max_rad), injection.amount);
}

// Rotation of the ground that gives a vehicle with this heading this roll or pitch.
Eigen::Matrix3d ground_rotation(const injection_t& injection, double heading_rad, Utime now) {
  const double angle = tilt_rad(injection, now);
  const Eigen::Matrix3d heading = rotation_from_rpy(0.0, 0.0, heading_rad);
  const Eigen::Matrix3d tilt =
      injection.fault == "tilt_roll" ? rotation_from_rpy(angle, 0.0, 0.0) : rotation_from_rpy(0.0, angle, 0.0);
  return heading * tilt * heading.transpose();
}

}  // namespace

void WorldFaults::begin(const injection_t& injection, double heading_rad) {
  if (injection.fault == "clock_step")
    clock_step_ += kTickUs * std::lround(injection.amount / to_seconds(kTickUs));
  else
    active_.push_back({injection, heading_rad});
}

SensorFaults WorldFaults::sensors(Utime now) const {
  SensorFaults sensors;
  for (const Active& active : active_)
    if (is_active(active.injection, now)) apply_sensor_fault(active.injection, sensors);
  return sensors;
}

VehicleFaults WorldFaults::vehicle(Utime now) const {
  VehicleFaults vehicle;
  for (const auto& [injection, heading_rad] : active_) {
    if (injection.fault.rfind("tilt_", 0) == 0)
      vehicle.R_level_ground = ground_rotation(injection, heading_rad, now) * vehicle.R_level_ground;
    if (!is_active(injection, now)) continue;
    if (injection.fault == "wheel_jammed") vehicle.jammed.at(std::stoul(injection.target)) = true;
    if (injection.fault == "loose_sand") vehicle.loose_sand = true;
  }
  return vehicle;
}

Utime WorldFaults::take_clock_step() {
  return std::exchange(clock_step_, 0);
}

}  // namespace rover
