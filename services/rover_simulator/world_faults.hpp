// Active faults of the simulated world, and their effect on sensors, vehicle and clock.
#pragma once

#include <rover/injection_t.hpp>
#include <vector>

#include "common/bus/faults.hpp"
#include "common/core/time.hpp"
#include "rover_simulator/sensor_faults.hpp"
#include "rover_simulator/vehicle/vehicle_sim.hpp"

namespace rover {

class WorldFaults {
 public:
  // For faults of FaultTarget::kWorld. A tilt keeps the rover's heading at its start.
  void begin(const injection_t& injection, double heading_rad);
  SensorFaults sensors(Utime now) const;
  VehicleFaults vehicle(Utime now) const;
  // Pending clock step; cleared by the call.
  Utime take_clock_step();

 private:
  struct Active {
    injection_t injection;
    double heading_rad;
  };
  std::vector<Active> active_;
  Utime clock_step_ = 0;
};

}  // namespace rover
