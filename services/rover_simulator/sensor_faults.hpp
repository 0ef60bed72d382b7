// Applies sensor faults to fault-free samples.
#pragma once

#include <array>

#include "rover_simulator/camera/stereo_camera_sim.hpp"
#include "rover_simulator/lens_faults.hpp"
#include "rover_simulator/vehicle/sensors.hpp"

namespace rover {

struct SensorFaults {
  std::array<CameraFault, 4> camera;  // left, right; LocCam, then NavCam
  bool imu_dead = false;
  double yaw_bias_radps = 0.0;
  double forward_bias_mps2 = 0.0;
  std::array<bool, 6> encoder_stuck{};
};

// Must process every sample, because it stores the last one for frozen and stuck faults.
class SensorFaultModel {
 public:
  ImuSample imu(const SensorFaults& faults, ImuSample sample) const;
  WheelSample wheels(const SensorFaults& faults, WheelSample sample);
  enum class StereoPair : size_t { kLocCam = 0, kNavCam = 2 };  // index of the left camera; the right one is next
  StereoCameraSim::Pair images(const SensorFaults& faults, StereoPair stereo_pair, StereoCameraSim::Pair pair);

 private:
  GrayImage faulty_image(const CameraFault& fault, GrayImage image, GrayImage& last) const;

  WheelSample last_wheels_;
  std::array<GrayImage, 4> last_;
};

}  // namespace rover
