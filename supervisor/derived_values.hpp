// Values derived from several messages over time: motor i2t loads, message loss, service starts, clock steps, motion
// without a permit, and permits that are not used.
#pragma once

#include <deque>

#include "supervisor/motor_thermal_model.hpp"
#include "supervisor/quantities.hpp"

namespace rover::supervisor {

struct DerivedValueConfig {
  double drive_nominal_a = 3.17;
  double steer_nominal_a = 0.516;
  double motor_thermal_time_s = 60.0;  // time constant of a motor winding
  double wheel_radius_m = 0.125;
  double stationary_wheel_mps = 0.03;
  double loss_window_s = 4.0;
  double start_window_s = 60.0;
  double fault_stop_distance_m = 10.0;
};

// The parts of DerivedValueTracker that survive a restart of the supervisor.
struct MotorHeat {
  Utime utime = kNever;  // of the newest WHEEL_STATE
  std::array<double, 6> drive_i2t_load{};
  std::array<double, 4> steer_i2t_load{};

  bool operator==(const MotorHeat&) const = default;
};
struct EventCounters {
  std::map<std::string, std::deque<Utime>> starts;
  std::deque<double> fault_stops_m;  // odometer at each

  bool operator==(const EventCounters&) const = default;
};

class DerivedValueTracker {
 public:
  explicit DerivedValueTracker(const DerivedValueConfig& config);

  void on_wheels(const WheelReport& wheels);
  // `now` replaces the previous report `before` of that service.
  void on_service(const std::string& name, const ServiceReport& before, const ServiceReport& now);
  void on_fault_stop() { counters_.fault_stops_m.push_back(travelled_m_); }
  void set_restart_attempts(std::map<std::string, int> restart_attempts) {
    derived_.restart_attempts = std::move(restart_attempts);
  }
  // Clears the counts of service starts and fault stops.
  void reset_counters();
  // Each tick, before the monitors run. `permitted`: permit state of the previous tick.
  void step(Utime now, const Inputs& inputs, bool permitted);

  const DerivedValues& values() const { return derived_; }
  const MotorHeat& heat() const { return heat_; }
  const EventCounters& counters() const { return counters_; }
  void restore(const MotorHeat& heat, const EventCounters& counters);

 private:
  struct Loss {
    Utime utime;
    std::int64_t received;
    std::int64_t lost;
  };
  void set_loads();
  void step_fault_stops();
  void step_losses(Utime now);
  void step_starts(Utime now);
  void step_motion(Utime now, const Inputs& inputs, bool permitted);

  DerivedValueConfig config_;
  DerivedValues derived_;
  std::vector<MotorThermalModel> drive_thermal_, steer_thermal_;
  std::deque<Loss> losses_;
  MotorHeat heat_;
  EventCounters counters_;
  double travelled_m_ = 0.0;  // newest finite odometer
  Utime last_tick_ = kNever;
  Utime newest_report_ = kNever;  // newest heartbeat
  Utime moving_since_ = kNever;   // wheels turn without a permit
  Utime idle_since_ = kNever;     // wheels rest with a permit
};

}  // namespace rover::supervisor
