#include "rover_simulator/sensor_faults.hpp"

#include <algorithm>

namespace rover {
namespace {

GrayImage shifted(const GrayImage& image, int rows, int columns) {
  GrayImage out(image.width, image.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      out.at(x, y) = image.at(std::clamp(x - columns, 0, image.width - 1), std::clamp(y - rows, 0, image.height - 1));
  return out;
}

}  // namespace

ImuSample SensorFaultModel::imu(const SensorFaults& faults, ImuSample sample) const {
  sample.delta_angle_rad.z() += faults.yaw_bias_radps * sample.dt_s;
  sample.fog_delta_yaw_rad += faults.yaw_bias_radps * sample.dt_s;
  sample.delta_velocity_mps.x() += faults.forward_bias_mps2 * sample.dt_s;
  return sample;
}

WheelSample SensorFaultModel::wheels(const SensorFaults& faults, WheelSample sample) {
  for (size_t i = 0; i < sample.drive_angle_rad.size(); ++i) {
    if (!faults.encoder_stuck[i]) continue;
    sample.drive_angle_rad[i] = last_wheels_.drive_angle_rad[i];
    sample.drive_rate_radps[i] = 0.0;
  }
  last_wheels_ = sample;
  return sample;
}

StereoCameraSim::Pair SensorFaultModel::images(const SensorFaults& faults, StereoPair stereo_pair,
                                               StereoCameraSim::Pair pair) {
  const size_t left = static_cast<size_t>(stereo_pair), right = left + 1;
  pair.left = faulty_image(faults.camera[left], std::move(pair.left), last_[left]);
  pair.right = faulty_image(faults.camera[right], std::move(pair.right), last_[right]);
  return pair;
}

GrayImage SensorFaultModel::faulty_image(const CameraFault& fault, GrayImage image, GrayImage& last) const {
  if (fault.frozen && !last.data.empty()) image = last;
  last = image;
  if (fault.blind) std::fill(image.data.begin(), image.data.end(), std::uint8_t{0});
  if (fault.shift_rows != 0 || fault.shift_columns != 0) return shifted(image, fault.shift_rows, fault.shift_columns);
  return image;
}

}  // namespace rover
