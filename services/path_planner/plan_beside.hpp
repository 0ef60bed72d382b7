// Makes plans in a thread beside the node's. In lockstep each comes a fixed message time after it was wanted, however
// long it took, so that a run gives the same result on any machine; by the clock when it is there. One that presses is
// waited for: in lockstep it is there at once if its work is done within the patience.
#pragma once

#include <functional>
#include <future>

#include "path_planner/plan_job.hpp"

namespace rover::planning {

class PlanBeside final : public PlanMaker {
 public:
  struct Times {
    Utime latency = 0;
    Utime patience = 0;
  };

  // `by_clock`: whether message time follows the clock now.
  PlanBeside(const Times& times, std::function<bool()> by_clock) : times_(times), by_clock_(std::move(by_clock)) {}

  bool start(std::shared_ptr<const PlanJob> job, Utime now) override;
  std::optional<FullPlan> result(Utime now, bool pressing) override;

 private:
  bool at_work(Utime patience) const;
  bool there(Utime now, bool pressing) const;

  Times times_;
  std::function<bool()> by_clock_;
  Utime due_ = kNever;
  std::shared_future<FullPlan> plan_;
};

}  // namespace rover::planning
