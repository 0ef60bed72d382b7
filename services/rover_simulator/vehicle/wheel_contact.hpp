// Rigid wheel contact as a Winkler foundation (Bekker's sinkage law with exponent 1): the rim's lower half is divided
// into strips and segments, each a radial spring. Flat ground, edges and walls need no special cases.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "common/core/vehicle.hpp"
#include "rover_simulator/vehicle/height_cache.hpp"

namespace rover {

struct ContactConfig {
  int segments = 28;  // over the wheel's diameter: about the spacing of the height samples
  // Pressure per depth and per length of contact [N/m^2], by soil: a wheel under 60 N sinks about 8, 3, 1.5 mm.
  std::array<double, 3> stiffness_npm2{1.3e5, 5.7e5, 1.6e6};
  double damping_spm = 10.0;  // Hunt-Crossley: relative force increase per m/s of approach
};

struct WheelContact {
  double load_n = 0.0;                                // without damping; 0: no contact
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // mean direction of the load, in map axes
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // centre of pressure, map
  std::array<double, 3> soil_fraction{};              // of the load, by Soil
  double sinkage_m = 0.0;                             // maximum depth
  double climb_m = 0.0;                               // highest load-bearing rock surface, above the ground
};

// `R_map_hub`: axes of the wheel carrier, y along the axle to the left.
WheelContact find_contact(const ContactConfig& config, const Vehicle& vehicle, HeightCache& heights,
                          const Eigen::Vector3d& p_map_axle, const Eigen::Matrix3d& R_map_hub);
// climb_m under the wheel's edges, which carry no load: the strips lie 2 cm and more within them.
double climb_at_edges_m(const ContactConfig& config, const Vehicle& vehicle, HeightCache& heights,
                        const Eigen::Vector3d& p_map_axle, const Eigen::Matrix3d& R_map_hub);

}  // namespace rover
