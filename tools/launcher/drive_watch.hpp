// Monitors a drive on the bus: driver channels, goal, and the operator's STOP.
#pragma once

#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <rover/ground_command_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <string>

#include "tools/conform/listener.hpp"

namespace rover {

class DriveWatch {
 public:
  explicit DriveWatch(lcm::LCM& lcm);

  bool ticks_received() const { return ticks_received_; }
  // Checked once, after 3 s of ticks: silent channels, or clock offsets from TICK. Empty if not checked yet or no
  // problem.
  std::string driver_problem();
  // At the goal for one second of message time, so that the log contains it.
  bool stationary_at_goal() const { return states_at_goal_ >= 10; }
  // True after STOP at the goal. Elsewhere STOP only stops the rover.
  bool stop_commanded() const { return stop_commanded_; }
  // Wall time since the last tick, or since the start.
  double tick_age_s() const { return std::chrono::duration<double>(Clock::now() - ticked_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  void on_tick();
  void on_state(const supervisor_state_t& state);
  void on_command(const ground_command_t& command);

  std::optional<conform::Listener> driver_;  // until checked
  bool ticks_received_ = false;
  int states_at_goal_ = 0;
  bool stop_commanded_ = false;
  Clock::time_point ticked_ = Clock::now();
};

}  // namespace rover
