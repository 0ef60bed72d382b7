// A thread beside the node's. In lockstep a result comes a fixed message time after it was asked for, however long it
// took, so that a run gives the same result on any machine; by the clock when it is there.
#pragma once

#include <functional>
#include <future>

#include "path_planner/background.hpp"

namespace rover::planning {

class BackgroundThread final : public Background {
 public:
  // `by_clock`: whether message time follows the clock now.
  BackgroundThread(Utime latency, std::function<bool()> by_clock) : latency_(latency), by_clock_(std::move(by_clock)) {}

  bool start(PlanJob job, Utime now) override {
    if (by_clock_() && running()) return false;
    if (result_.valid()) result_.wait();  // nobody waits for it any more
    due_ = now + latency_;
    result_ = std::async(std::launch::async, std::move(job));
    return true;
  }
  std::optional<Plan> result(Utime now) override {
    if (!result_.valid() || now < due_ || (by_clock_() && running())) return std::nullopt;
    return result_.get();
  }

 private:
  bool running() const {
    return result_.valid() && result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
  }

  Utime latency_;
  std::function<bool()> by_clock_;
  Utime due_ = kNever;
  std::future<Plan> result_;
};

}  // namespace rover::planning
