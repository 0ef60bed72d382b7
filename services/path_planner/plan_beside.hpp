// Makes plans in a thread beside the node's. In lockstep each comes a fixed message time after it was wanted, however
// long it took, so that a run gives the same result on any machine; by the clock when it is there.
#pragma once

#include <functional>
#include <future>

#include "path_planner/plan_job.hpp"

namespace rover::planning {

class PlanBeside final : public PlanMaker {
 public:
  // `by_clock`: whether message time follows the clock now.
  PlanBeside(Utime latency, std::function<bool()> by_clock) : latency_(latency), by_clock_(std::move(by_clock)) {}

  bool start(std::shared_ptr<const PlanJob> job, Utime now) override;
  std::optional<FullPlan> result(Utime now) override;

 private:
  bool at_work() const;

  Utime latency_;
  std::function<bool()> by_clock_;
  Utime due_ = kNever;
  std::future<FullPlan> plan_;
};

}  // namespace rover::planning
