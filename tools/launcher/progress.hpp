// Terminal progress of a run: distance, speed, state, hazards, estimated end.
#pragma once

#include <chrono>
#include <cstdint>
#include <lcm/lcm-cpp.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <string>

namespace rover {

class Progress {
 public:
  explicit Progress(lcm::LCM& lcm);
  // Prints if an update is due: on a terminal it updates one line, else it prints a line every ten seconds.
  void show();
  // Ends the progress line.
  void finish();
  // True once POSE was received.
  bool started() const { return pose_.header.utime >= 0; }
  // True if message time advances without STATE. Only the launcher can restart a hung supervisor.
  bool supervisor_hangs() const;
  // Restarts the supervisor timeout.
  void supervisor_killed() { state_.header.utime = pose_.header.utime; }

 private:
  using Clock = std::chrono::steady_clock;
  template <class Message>
  void listen(lcm::LCM& lcm, const char* channel, Message& newest);
  std::string line() const;

  bool terminal_;
  pose_t pose_{};
  planner_status_t planner_{};
  supervisor_state_t state_{};
  std::int64_t first_utime_ = -1;
  Clock::time_point started_ = Clock::now();
  Clock::time_point shown_{};
  std::int8_t shown_state_ = -1;
};

}  // namespace rover
