// The vehicle as a MuJoCo model: free chassis; triple-bogie suspension (left and right bogies carry front and middle
// wheel and pivot about y, the rear one carries both rear wheels and pivots about x); four steered corners; six wheels.
#pragma once

#include <string>

#include "common/core/vehicle.hpp"
#include "rover_simulator/vehicle/vehicle_sim.hpp"

namespace rover {

// Joints: "chassis", "bogie0..2" (left, right, rear), "steer0..3", "drive0..5"; bodies: "chassis", "wheel0..5".
// Sites: points on the underside of the bogies' beams, which lie over the wheels, and at the foot of the forks, one on
// the inner side of each wheel.
std::string make_mjcf(const Vehicle& vehicle, const VehicleSimConfig& config);

}  // namespace rover
