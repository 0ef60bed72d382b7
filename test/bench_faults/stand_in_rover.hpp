// Kinematic replacement of the simulator: vehicle and sensors on ground that can be tilted, with injectable defects.
#pragma once

#include <array>
#include <random>
#include <rover/imu_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/core/time.hpp"
#include "test/bench_faults/field.hpp"
#include "test/trajectory_control/kinematic_rover.hpp"

namespace rover::bench_faults {

// Active defects; default: none.
struct Broken {
  bool imu_fault = false;           // reported by the unit
  bool wheel_fault = false;         // reported by the driver
  std::array<double, 6> drive_a{};  // replaces the motor current if not 0
  std::array<double, 4> steer_a{};
  double slip_ratio = 0.0;
  double roll_rad = 0.0;   // tilt of the ground
  double pitch_rad = 0.0;  // positive nose down
  double tilt_radps = 0.35;
  double shove_mps = 0.0;    // sideways motion without the wheels
  double runaway_mps = 0.0;  // the driver turns the wheels without a command
  bool stands = false;       // the driver turns no wheel, whatever the command
};

class StandInRover {
 public:
  StandInRover(const Vehicle& vehicle, std::uint64_t seed) : vehicle_(vehicle), rover_(vehicle), random_(seed) {}

  // Moves to `now` with the newest command; a jump of the clock causes no motion.
  void step(Utime now);
  void command(const wheel_command_t& command) { command_ = command; }

  imu_t imu();
  wheel_state_t wheels() const;
  truth_t truth() const;
  Eigen::Isometry3d T_map_body() const;
  const Pose2& pose() const { return rover_.pose(); }
  double speed_mps() const { return std::abs(rover_.twist().forward_mps); }

  Broken broken;

 private:
  WheelSetpoints obeyed() const;
  void tilt(double dt_s);
  double noise(double sigma);

  Vehicle vehicle_;
  test::KinematicRover rover_;
  std::mt19937_64 random_;
  Utime now_ = 0;
  wheel_command_t command_{};
  double roll_rad_ = 0.0;
  double pitch_rad_ = 0.0;
  double shove_mps_ = 0.0;
  std::array<double, 6> drive_angle_rad_{};
  std::array<double, 4> steer_before_rad_{};
  Eigen::Isometry3d T_before_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_mps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_before_mps_ = Eigen::Vector3d::Zero();
};

}  // namespace rover::bench_faults
