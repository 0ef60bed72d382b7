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
  double thermal_time_s = 60.0;  // thermal time constant of a motor winding
  double wheel_radius_m = 0.125;
  double stationary_wheel_mps = 0.03;
  double loss_window_s = 4.0;
  double start_window_s = 60.0;
  double fault_stop_distance_m = 10.0;
};

class DerivedValueTracker {
 public:
  explicit DerivedValueTracker(const DerivedValueConfig& config);

  void on_wheels(const WheelReport& wheels);
  // `now` replaces the previous report `before` of that service.
  void on_service(const std::string& name, const ServiceReport& before, const ServiceReport& now);
  void on_fault_stop(double travelled_m) { fault_stops_.push_back(travelled_m); }
  void set_restart_attempts(std::map<std::string, int> restart_attempts) {
    derived_.restart_attempts = std::move(restart_attempts);
  }
  // Clears the counts of service starts and fault stops.
  void reset_counters(const Inputs& inputs);
  // Each tick, before the monitors run. `permitted`: permit state of the previous tick.
  void step(Utime now, const Inputs& inputs, bool permitted);

  const DerivedValues& values() const { return derived_; }

 private:
  struct Loss {
    Utime utime;
    std::int64_t received;
    std::int64_t lost;
  };
  void step_fault_stops(const Inputs& inputs);
  void step_losses(Utime now);
  void step_starts(Utime now);
  void step_motion(Utime now, const Inputs& inputs, bool permitted);

  DerivedValueConfig config_;
  DerivedValues derived_;
  std::vector<MotorThermalModel> drive_thermal_, steer_thermal_;
  std::deque<Loss> losses_;
  std::map<std::string, std::deque<Utime>> starts_;
  std::deque<double> fault_stops_;
  Utime last_tick_ = kNever;
  Utime newest_report_ = kNever;  // newest heartbeat
  Utime moving_since_ = kNever;   // wheels turn without a permit
  Utime idle_since_ = kNever;     // wheels rest with a permit
};

}  // namespace rover::supervisor
