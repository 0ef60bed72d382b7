// Termination conditions of a simulated run, in message time.
#pragma once

#include <optional>
#include <string>

#include "common/core/time.hpp"

namespace rover {

struct RunEndConfig {
  double linger_s = 2.0;      // delay after the rover reports arrival or gives up
  double stuck_s = 120.0;     // maximum duration of one fault stop
  double timeout_s = 3600.0;  // of message time since the first tick
};

// Derived from the last supervisor_state_t.
enum class RoverPhase { kDriving, kArrived, kGivenUp, kFaultStop };

class RunEnd {
 public:
  RunEnd(const RunEndConfig& config, Utime start) : config_(config), start_(start) {}

  void phase(RoverPhase phase, Utime since) {
    if (phase != phase_) entered_ = since;
    phase_ = phase;
  }

  // Outcome if the run ends now: goal_reached, fault_stop or timeout.
  std::optional<std::string> outcome_at(Utime now) const {
    const double duration_s = to_seconds(now - entered_);
    if (phase_ == RoverPhase::kArrived && duration_s >= config_.linger_s) return "goal_reached";
    if (phase_ == RoverPhase::kGivenUp && duration_s >= config_.linger_s) return "fault_stop";
    if (phase_ == RoverPhase::kFaultStop && duration_s >= config_.stuck_s) return "fault_stop";
    if (to_seconds(now - start_) >= config_.timeout_s) return "timeout";
    return std::nullopt;
  }

 private:
  RunEndConfig config_;
  Utime start_;
  RoverPhase phase_ = RoverPhase::kDriving;
  Utime entered_ = 0;
};

}  // namespace rover
