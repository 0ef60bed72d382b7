// Simulated vehicle: MuJoCo multibody dynamics with custom wheel contact, wheel-soil force and motor models.
// Deterministic: the same surface, start and commands give the same bytes.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>

#include "common/core/frames.hpp"
#include "common/core/vehicle.hpp"
#include "rover_simulator/vehicle/motors.hpp"
#include "rover_simulator/vehicle/wheel_contact.hpp"
#include "rover_simulator/vehicle/wheel_soil.hpp"
#include "rover_simulator/world/surface.hpp"

namespace rover {

// Orders: wheels FL FR ML MR RL RR, steered wheels FL FR RL RR, bogies left, right, rear.
struct WheelCommand {
  std::array<double, 6> drive_rate_radps{};
  std::array<double, 4> steer_angle_rad{};
};

struct VehicleSimConfig {
  double gravity_mps2 = 3.71;
  double step_s = 0.002;
  double settle_s = 2.0;               // before the first tick, wheels at rest
  double bogie_mass_kg = 2.0;          // each of the three
  double bogie_pivot_height_m = 0.10;  // over the wheels' axles
  double bogie_damping_nms = 8.0;
  double bogie_limit_rad = 0.6;
  ContactConfig contact;
  WheelSoilConfig soil;
  DriveMotorConfig drive;
  SteerMotorConfig steer;
};

// Faults of the vehicle and of the ground under it.
struct VehicleFaults {
  std::array<bool, 6> jammed{};  // wheel locked, motor still driven
  bool loose_sand = false;       // under all wheels
  // Virtual rotation of the ground: acts on gravity and gyros, not on cameras or the map.
  Eigen::Matrix3d R_level_ground = Eigen::Matrix3d::Identity();
};

enum class Collision : std::int8_t { kNone = 0, kBodyContact = 1, kWheelClimb = 2 };

// State at the end of the last advance(), in map and body axes; delta values cover that interval.
struct VehicleTruth {
  Eigen::Isometry3d T_map_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_map_mps = Eigen::Vector3d::Zero();  // of the body origin
  Eigen::Vector3d rate_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_body_mps2 = Eigen::Vector3d::Zero();  // at the IMU, mean over the interval
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();           // of the body over the interval, body axes
  Eigen::Vector3d delta_velocity_mps = Eigen::Vector3d::Zero();  // integral of specific force at the IMU, body axes
  double interval_s = 0.0;
  std::array<double, 6> wheel_angle_rad{};  // unwrapped, positive forward
  std::array<double, 6> wheel_rate_radps{};
  std::array<double, 6> drive_current_a{};
  std::array<double, 4> steer_angle_rad{};
  std::array<double, 4> steer_current_a{};
  std::array<double, 3> bogie_angle_rad{};
  std::array<double, 6> wheel_load_n{};
  std::array<double, 6> wheel_slip{};  // 1 - v / (w R); 0 for a nearly stationary wheel
  std::array<double, 6> wheel_sinkage_m{};
  std::array<Soil, 6> wheel_soil{};
  double clearance_m = 0.0;  // belly above ground and rocks
  double climb_m = 0.0;      // highest rock surface under a wheel, above the ground
  Collision collision = Collision::kNone;
};

class VehicleSim {
 public:
  // Settles on the surface within a few millimetres of the start pose. The surface must outlive the object.
  VehicleSim(const Vehicle& vehicle, const VehicleSimConfig& config, const Surface& surface, const Pose2& start);
  ~VehicleSim();
  VehicleSim(const VehicleSim&) = delete;
  VehicleSim& operator=(const VehicleSim&) = delete;

  void advance(double dt_s, const WheelCommand& command);
  // Effective from the next advance().
  void set_faults(const VehicleFaults& faults);
  const VehicleTruth& truth() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rover
