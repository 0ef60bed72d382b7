// Simulated vehicle with sensors, cameras and terrain.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "common/core/camera_rig.hpp"
#include "common/core/time.hpp"
#include "common/core/vehicle.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"
#include "rover_simulator/vehicle/pan_tilt_sim.hpp"
#include "rover_simulator/vehicle/sensors.hpp"
#include "rover_simulator/vehicle/vehicle_sim.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {

struct SimulatedRoverConfig {
  VehicleSimConfig vehicle;
  SensorConfig sensors;
  CameraSimConfig loccam;
  std::optional<StereoRig> navcam;                   // empty: no NavCam. It shares the LocCam's scene.
  double pan_tilt_repeatability_rad = to_rad(0.02);  // one sigma, estimated from 0.05 deg between extremes
  double mounting_error_rad = 0.0;                   // of both cameras, one sigma about each axis of the body
  double start_sigma_m = 0.0;                        // error of the start pose given to the rover
  double start_sigma_yaw_rad = 0.0;
};

class SimulatedRover {
 public:
  SimulatedRover(const SimulatedRoverConfig& config, const Vehicle& vehicle, const StereoRig& loccam,
                 std::unique_ptr<World> world, const Pose2& start_estimate, std::uint64_t seed);

  void advance(double dt_s, const WheelCommand& command);
  void set_faults(const VehicleFaults& faults) { vehicle_.set_faults(faults); }
  // Zero drive rates at the current steering angles; used when the command has expired.
  WheelCommand hold_command() const;

  const VehicleTruth& truth() const { return vehicle_.truth(); }
  Eigen::Isometry3d T_map_body() const { return vehicle_.truth().T_map_body; }
  // Samples over the last advance() interval.
  const ImuSample& imu() const { return imu_; }
  const WheelSample& wheels() const { return wheels_; }
  // Null without a NavCam.
  PanTiltSim* pan_tilt() { return pan_tilt_ ? &*pan_tilt_ : nullptr; }
  // True pose of the left LocCam; of the left NavCam at the current pan and tilt.
  Eigen::Isometry3d T_map_loccam() const { return T_map_body() * loccam_rig_.T_body_left; }
  Eigen::Isometry3d T_map_navcam() const;
  // The cameras as they are, with their calibration errors.
  StereoRig true_loccam() const;
  StereoRig true_navcam() const;
  const World& world() const { return *world_; }
  // Safe to call concurrently with advance() and each other.
  StereoCameraSim::Pair expose_loccam(const Eigen::Isometry3d& T_map_left, std::int64_t frame);
  StereoCameraSim::Pair expose_navcam(const Eigen::Isometry3d& T_map_left, std::int64_t frame);

 private:
  StereoCameraSim::Pair expose(std::unique_ptr<StereoCameraSim>& camera, const StereoRig& rig, std::uint64_t seed,
                               const Eigen::Isometry3d& T_map_left, std::int64_t frame);

  SimulatedRoverConfig config_;
  Vehicle geometry_;
  StereoRig loccam_rig_;  // as mounted, calibration nominal; so is the NavCam's of config_
  std::unique_ptr<World> world_;
  VehicleSim vehicle_;
  SensorSuite sensors_;
  std::optional<PanTiltSim> pan_tilt_;
  std::mutex scene_mutex_;            // only one camera may render at a time
  std::shared_ptr<TileScene> scene_;  // this and the cameras are created on first use
  std::unique_ptr<StereoCameraSim> loccam_;
  std::unique_ptr<StereoCameraSim> navcam_;
  std::uint64_t loccam_seed_;
  std::uint64_t navcam_seed_;
  ImuSample imu_;
  WheelSample wheels_;
};

}  // namespace rover
