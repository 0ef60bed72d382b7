// When a simulated run is over, by message time alone.
#pragma once

#include <optional>
#include <string>

#include "common/core/time.hpp"

namespace rover {

struct RunEndConfig {
  double linger_s = 2.0;      // after the rover says that it has arrived, or that it will not go on
  double stuck_s = 120.0;     // standing in one fault stop for so long ends the run
  double timeout_s = 3600.0;  // of message time since the first tick
};

// What the supervisor last said of itself, in the words of supervisor_state_t.
enum class RoverPhase { kUnderWay, kArrived, kGivenUp, kFaultStop };

class RunEnd {
 public:
  RunEnd(const RunEndConfig& config, Utime start) : config_(config), start_(start) {}

  void phase(RoverPhase phase, Utime since) {
    if (phase != phase_) entered_ = since;
    phase_ = phase;
  }

  // Why the run is over at this time, if it is: goal_reached, fault_stop or timeout.
  std::optional<std::string> over(Utime now) const {
    const double standing_s = to_seconds(now - entered_);
    if (phase_ == RoverPhase::kArrived && standing_s >= config_.linger_s) return "goal_reached";
    if (phase_ == RoverPhase::kGivenUp && standing_s >= config_.linger_s) return "fault_stop";
    if (phase_ == RoverPhase::kFaultStop && standing_s >= config_.stuck_s) return "fault_stop";
    if (to_seconds(now - start_) >= config_.timeout_s) return "timeout";
    return std::nullopt;
  }

 private:
  RunEndConfig config_;
  Utime start_;
  RoverPhase phase_ = RoverPhase::kUnderWay;
  Utime entered_ = 0;
};

}  // namespace rover
