// What the terminal shows of a run: distance, speed, state, hazards, expected end.
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
  // `enabled`: print at all; on a terminal one line is kept up to date, else a line comes every ten seconds.
  Progress(lcm::LCM& lcm, bool enabled);
  // Prints what is due.
  void show();
  // Leaves the terminal on a fresh line.
  void finish();
  // Whether the rover has been heard: the world has begun.
  bool started() const { return pose_.header.utime >= 0; }
  // Whether the rover's time goes on without a word from its supervisor, which nobody else would start anew when it
  // hangs.
  bool supervisor_hangs() const;
  // Give it time again.
  void supervisor_killed() { state_.header.utime = pose_.header.utime; }

 private:
  using Clock = std::chrono::steady_clock;
  template <class Message>
  void listen(lcm::LCM& lcm, const char* channel, Message& newest);
  std::string line() const;

  bool enabled_;
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
