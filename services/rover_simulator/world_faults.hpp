// Faults that the simulator does to its own world: who stands, and what they make of sensors, vehicle and clock.
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
  // Faults of FaultTarget::kWorld. A slope keeps the direction that the rover's heading gives it here.
  void begin(const injection_t& injection, double heading_rad);
  SensorFaults sensors(Utime now) const;
  VehicleFaults vehicle(Utime now) const;
  // By how much the clock is to jump, once.
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
