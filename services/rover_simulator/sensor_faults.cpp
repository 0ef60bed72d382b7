#include "rover_simulator/sensor_faults.hpp"

#include <utility>

namespace rover {

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
  return seen_with(fault, std::move(image));
}

}  // namespace rover
