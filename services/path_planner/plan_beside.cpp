#include "path_planner/plan_beside.hpp"

#include <chrono>

namespace rover::planning {

bool PlanBeside::start(std::shared_ptr<const PlanJob> job, Utime now) {
  if (at_work()) return false;
  if (plan_.valid()) plan_.get();  // nobody waits for it any more
  due_ = now + latency_;
  plan_ = std::async(std::launch::async, [job = std::move(job)] { return job->run(); });
  return true;
}

std::optional<FullPlan> PlanBeside::result(Utime now) {
  if (!plan_.valid() || now < due_ || at_work()) return std::nullopt;
  return plan_.get();
}

bool PlanBeside::at_work() const {
  return by_clock_() && plan_.valid() && plan_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

}  // namespace rover::planning
