// Clearance between the chassis box's underside and the surface.
#pragma once

#include <Eigen/Geometry>

#include "common/core/vehicle.hpp"
#include "rover_simulator/vehicle/height_cache.hpp"

namespace rover {

// Minimum vertical distance over the underside, sampled on a 5 cm grid; negative: contact.
double belly_clearance_m(const Vehicle& vehicle, HeightCache& heights, const Eigen::Isometry3d& T_map_body);

}  // namespace rover
