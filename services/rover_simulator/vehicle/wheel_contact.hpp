// Contact of a rigid wheel with the surface: the rim's lower half is cut into strips across and segments along, and
// each segment that lies inside the wheel pushes radially like a spring (a Winkler foundation, Bekker's sinkage law
// with exponent 1). Flat ground, edges and walls need no cases of their own.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "common/core/vehicle.hpp"
#include "rover_simulator/vehicle/height_cache.hpp"

namespace rover {

struct ContactConfig {
  int segments = 28;  // over the wheel's diameter: about the height samples' own spacing
  // Pressure per depth and per length of contact [N/m^2], by soil: a wheel under 60 N sinks about 8, 3, 1.5 mm.
  std::array<double, 3> stiffness_npm2{1.3e5, 5.7e5, 1.6e6};
  double damping_spm = 10.0;  // Hunt and Crossley's: force grows by this share per m/s of approach
};

struct WheelContact {
  double load_n = 0.0;                                // without damping; 0: in the air
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // mean direction of the load, in map axes
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // centre of pressure, map
  std::array<double, 3> soil_share{};                 // of the load, by Soil
  double sinkage_m = 0.0;                             // greatest depth
  double climb_m = 0.0;                               // highest rock surface that carries, over the ground
};

// `R_map_hub`: axes of the wheel's carrier, y along the axle to the left.
WheelContact find_contact(const ContactConfig& config, const Vehicle& vehicle, HeightCache& heights,
                          const Eigen::Vector3d& p_map_axle, const Eigen::Matrix3d& R_map_hub);

}  // namespace rover
