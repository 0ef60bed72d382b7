#include "path_planner/plan_beside.hpp"

#include <chrono>

namespace rover::planning {

bool PlanBeside::start(std::shared_ptr<const PlanJob> job, Utime now) {
  if (by_clock_() && at_work(0)) return false;
  if (plan_.valid()) plan_.wait();  // nobody waits for it any more
  due_ = now + times_.latency;
  plan_ = std::async(std::launch::async, [job = std::move(job)] { return job->run(); });
  return true;
}

std::optional<FullPlan> PlanBeside::result(Utime now, bool pressing) {
  if (!plan_.valid() || !there(now, pressing)) return std::nullopt;
  return std::exchange(plan_, {}).get();
}

bool PlanBeside::there(Utime now, bool pressing) const {
  if (by_clock_()) return (pressing || now >= due_) && !at_work(pressing ? times_.patience : 0);
  return now >= due_ || (pressing && to_utime(plan_.get().work_s) <= times_.patience);
}

bool PlanBeside::at_work(Utime patience) const {
  return plan_.valid() && plan_.wait_for(std::chrono::microseconds(patience)) != std::future_status::ready;
}

}  // namespace rover::planning
