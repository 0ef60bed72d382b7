// What rows watch that no single message says: loads of motors, losses on the bus, starts of services, steps of the
// clock, motion that nobody permitted, and permits that nobody uses.
#pragma once

#include <deque>

#include "supervisor/motor_heat.hpp"
#include "supervisor/quantities.hpp"

namespace rover::supervisor {

struct DeriveConfig {
  double drive_nominal_a = 3.17;
  double steer_nominal_a = 0.516;
  double motor_time_s = 60.0;  // thermal time constant of a winding
  double wheel_radius_m = 0.125;
  double standing_wheel_mps = 0.03;
  double loss_window_s = 4.0;
  double start_window_s = 60.0;
  double fault_stop_way_m = 10.0;
};

class Derive {
 public:
  explicit Derive(const DeriveConfig& config);

  void on_wheels(const WheelReport& wheels);
  // In the place of the service's newest report before.
  void on_service(const std::string& name, const ServiceReport& before, const ServiceReport& now);
  void on_fault_stop(double travelled_m) { fault_stops_.push_back(travelled_m); }
  void set_tries(std::map<std::string, int> tries) { derived_.tries = std::move(tries); }
  // Starts of services and fault stops so far count no more.
  void forget_counts(const Inputs& in);
  // Each tick, before the rows are judged. `permitted`: at the tick before.
  void step(Utime now, const Inputs& in, bool permitted);

  const Derived& values() const { return derived_; }

 private:
  struct Loss {
    Utime utime;
    std::int64_t received;
    std::int64_t lost;
  };
  void step_fault_stops(const Inputs& in);
  void step_losses(Utime now);
  void step_starts(Utime now);
  void step_motion(Utime now, const Inputs& in, bool permitted);

  DeriveConfig config_;
  Derived derived_;
  std::vector<MotorHeat> drive_heat_, steer_heat_;
  std::deque<Loss> losses_;
  std::map<std::string, std::deque<Utime>> starts_;
  std::deque<double> fault_stops_;
  Utime last_tick_ = kNever;
  Utime newest_ = kNever;        // of the messages about services
  Utime moving_since_ = kNever;  // without a permit
  Utime idle_since_ = kNever;    // with one
};

}  // namespace rover::supervisor
