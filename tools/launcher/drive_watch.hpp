// What the launcher hears of a drive: the driver, the goal, the operator's order to stop.
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

  bool ticks_heard() const { return ticks_heard_; }
  // Judged once, when the driver has been heard for a while: what is missing of it, or how far the clocks of its parts
  // are from the one that gives TICK. Empty: nothing is known yet, or all is well.
  std::string driver_problem();
  // For a second of its time: the record holds it then.
  bool rests_at_goal() const { return states_at_goal_ >= 10; }
  // Asked for at the goal: elsewhere STOP is an order to the rover.
  bool stop_ordered() const { return stop_ordered_; }
  // Wall time since ticks came last, or since the beginning.
  double silence_s() const { return std::chrono::duration<double>(Clock::now() - ticked_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  void on_tick();
  void on_state(const supervisor_state_t& state);
  void on_command(const ground_command_t& command);

  std::optional<conform::Listener> driver_;  // until it is judged
  bool ticks_heard_ = false;
  int states_at_goal_ = 0;
  bool stop_ordered_ = false;
  Clock::time_point ticked_ = Clock::now();
};

}  // namespace rover
