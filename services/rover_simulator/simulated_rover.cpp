#include "rover_simulator/simulated_rover.hpp"

#include "common/core/check.hpp"
#include "rover_simulator/camera/calibration_error.hpp"
#include "rover_simulator/world/rover_streams.hpp"

namespace rover {
namespace {

Pose2 true_start(const SimulatedRoverConfig& config, const Pose2& estimate, std::uint64_t seed) {
  const std::array<double, 3> error = start_error(seed);
  Pose2 start = estimate;
  start.x_m += config.start_sigma_m * error[0];
  start.y_m += config.start_sigma_m * error[1];
  start.yaw_rad += config.start_sigma_yaw_rad * error[2];
  return start;
}

}  // namespace

SimulatedRover::SimulatedRover(const SimulatedRoverConfig& config, const Vehicle& vehicle, const StereoRig& loccam,
                               std::unique_ptr<World> world, const Pose2& start_estimate, std::uint64_t seed)
    : config_(config),
      geometry_(vehicle),
      loccam_rig_(with_mounting_error(loccam, config.mounting_error_rad, seed_of(seed, RoverStream::kCamera))),
      world_(std::move(world)),
      vehicle_(vehicle, config.vehicle, *world_, true_start(config, start_estimate, seed)),
      sensors_(config.sensors, seed_of(seed, RoverStream::kSensors)),
      loccam_seed_(seed_of(seed, RoverStream::kCamera)),
      navcam_seed_(seed_of(seed, RoverStream::kNavCam)) {
  if (config.navcam) config_.navcam = with_mounting_error(*config.navcam, config.mounting_error_rad, navcam_seed_);
  if (config.navcam && vehicle.pan_tilt)
    pan_tilt_.emplace(*vehicle.pan_tilt, config.pan_tilt_repeatability_rad, seed_of(seed, RoverStream::kPanTilt));
  advance(to_seconds(kTickUs), hold_command());
}

void SimulatedRover::advance(double dt_s, const WheelCommand& command) {
  vehicle_.advance(dt_s, command);
  if (pan_tilt_) pan_tilt_->advance(dt_s);
  imu_ = sensors_.sample_imu(vehicle_.truth());
  wheels_ = sensors_.sample_wheels(vehicle_.truth());
}

Eigen::Isometry3d SimulatedRover::T_map_navcam() const {
  ROVER_CHECK(pan_tilt_.has_value());
  return T_map_body() *
         T_body_navcam(*geometry_.pan_tilt, config_.navcam->T_body_left, pan_tilt_->pan_rad(), pan_tilt_->tilt_rad());
}

StereoRig SimulatedRover::true_loccam() const {
  return with_calibration_error(loccam_rig_, config_.loccam.calibration_error_px, loccam_seed_);
}

StereoRig SimulatedRover::true_navcam() const {
  ROVER_CHECK(config_.navcam.has_value());
  return with_calibration_error(*config_.navcam, config_.loccam.calibration_error_px, navcam_seed_);
}

StereoCameraSim::Pair SimulatedRover::expose_loccam(const Eigen::Isometry3d& T_map_left, std::int64_t frame) {
  return expose(loccam_, loccam_rig_, loccam_seed_, T_map_left, frame);
}

StereoCameraSim::Pair SimulatedRover::expose_navcam(const Eigen::Isometry3d& T_map_left, std::int64_t frame) {
  return expose(navcam_, *config_.navcam, navcam_seed_, T_map_left, frame);
}

StereoCameraSim::Pair SimulatedRover::expose(std::unique_ptr<StereoCameraSim>& camera, const StereoRig& rig,
                                             std::uint64_t seed, const Eigen::Isometry3d& T_map_left,
                                             std::int64_t frame) {
  const std::lock_guard lock(scene_mutex_);
  if (!scene_) scene_ = std::make_shared<TileScene>(*world_, config_.loccam.scene);
  if (!camera) camera = std::make_unique<StereoCameraSim>(rig, config_.loccam, scene_, seed);
  return camera->render_from(T_map_left, frame);
}

WheelCommand SimulatedRover::hold_command() const {
  WheelCommand hold;
  hold.steer_angle_rad = vehicle_.truth().steer_angle_rad;
  return hold;
}

}  // namespace rover
