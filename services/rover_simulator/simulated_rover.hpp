// The simulated vehicle with its sensors and cameras in its world.
#pragma once

#include <memory>

#include "common/core/camera_rig.hpp"
#include "common/core/time.hpp"
#include "common/core/vehicle.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"
#include "rover_simulator/vehicle/sensors.hpp"
#include "rover_simulator/vehicle/vehicle_sim.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {

struct SimulatedRoverConfig {
  VehicleSimConfig vehicle;
  SensorConfig sensors;
  CameraSimConfig loccam;
  double start_sigma_m = 0.0;  // the true start differs from the ground's belief by this much
  double start_sigma_yaw_rad = 0.0;
};

class SimulatedRover {
 public:
  SimulatedRover(const SimulatedRoverConfig& config, const Vehicle& vehicle, const StereoRig& loccam,
                 std::unique_ptr<World> world, const Pose2& believed_start, std::uint64_t seed);

  void advance(double dt_s, const WheelCommand& command);
  void set_faults(const VehicleFaults& faults) { vehicle_.set_faults(faults); }
  // Wheels at rest, steering as it stands: what the driver does when its command has expired.
  WheelCommand hold_command() const;

  const VehicleTruth& truth() const { return vehicle_.truth(); }
  Eigen::Isometry3d T_map_body() const { return vehicle_.truth().T_map_body; }
  // Of the interval that the last advance() ended.
  const ImuSample& imu() const { return imu_; }
  const WheelSample& wheels() const { return wheels_; }
  // Thread safe against advance().
  StereoCameraSim::Pair expose_loccam(const Eigen::Isometry3d& T_map_body, std::int64_t frame) {
    return loccam_.render(T_map_body, frame);
  }

 private:
  std::unique_ptr<World> world_;
  VehicleSim vehicle_;
  SensorSuite sensors_;
  StereoCameraSim loccam_;
  ImuSample imu_;
  WheelSample wheels_;
};

}  // namespace rover
