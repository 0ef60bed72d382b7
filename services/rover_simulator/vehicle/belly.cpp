#include "rover_simulator/vehicle/belly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover {

double belly_clearance_m(const Vehicle& vehicle, HeightCache& heights, const Eigen::Isometry3d& T_map_body) {
  constexpr double kStepM = 0.05;
  const int nx = static_cast<int>(std::ceil(vehicle.body_half_length_m / kStepM));
  const int ny = static_cast<int>(std::ceil(vehicle.body_half_width_m / kStepM));
  const double z = vehicle.belly_clearance_m - vehicle.origin_height_m;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -nx; i <= nx; ++i)
    for (int j = -ny; j <= ny; ++j) {
      const Eigen::Vector3d p =
          T_map_body * Eigen::Vector3d(vehicle.body_half_length_m * i / nx, vehicle.body_half_width_m * j / ny, z);
      least = std::min(least, p.z() - heights.height_m(p.x(), p.y()));
    }
  return least;
}

}  // namespace rover
