// When the services of the Full level run: while they are wanted, and a while longer.
#pragma once

#include <utility>

#include "common/core/time.hpp"

namespace rover::supervisor {

class OnDemand {
 public:
  // Leaving: the clock master lets them go before their processes end, so that a run does not depend on how fast they
  // do.
  enum class State { kRunning, kLeaving, kStopped };

  // linger_s: how long they run on unwanted.
  explicit OnDemand(double linger_s) : linger_(to_utime(linger_s)) {}

  // Each step; true at the first and if the state has changed.
  bool step(Utime now, bool wanted) {
    const bool first = since_ == kNever;
    if (first || (wanted && state_ == State::kRunning)) since_ = now;
    const Utime passed = now - since_;
    State next = state_;
    if (state_ == State::kRunning && passed >= linger_) next = State::kLeaving;
    if (state_ == State::kLeaving && passed >= kLeaveUs) next = State::kStopped;
    if (state_ == State::kStopped && wanted) next = State::kRunning;
    if (next != state_) since_ = now;
    return std::exchange(state_, next) != next || first;
  }
  State state() const { return state_; }

 private:
  static constexpr Utime kLeaveUs = 500'000;  // several STATE
  Utime linger_;
  State state_ = State::kRunning;
  Utime since_ = kNever;  // of the state; running: last wanted
};

}  // namespace rover::supervisor
