// A plan of the Full level as a job: all that it is made of, so that the planner goes on with its frames meanwhile. It
// takes 0.1 s where the way is clear, and seconds where nothing leads on; a planner that tells nothing for so long is
// as good as dead (planner_age).
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/time.hpp"
#include "path_planner/full_planner.hpp"

namespace rover::planning {

class PlanJob {
 public:
  // The request, but for its ground, refers to the job itself.
  PlanJob(const FullPlannerConfig& config, const HazardMemory& memory, const GroundMap& ground, const Route& global,
          const std::vector<DeadEnd>& dead_ends);
  PlanJob(const PlanJob&) = delete;
  PlanJob& operator=(const PlanJob&) = delete;

  FullRequest& request() { return request_; }
  const FullRequest& request() const { return request_; }
  // By all that is known, else with point turns at the least margin, else with less and less taken for known.
  FullPlan run() const;

 private:
  FullPlan run_in_doubt(const Terrain::Doubt& doubt) const;

  FullPlannerConfig config_;
  HazardMemory memory_;
  GroundMap ground_;
  Route global_;
  std::vector<DeadEnd> dead_ends_;
  FullRequest request_;
};

// Makes plans one by one.
class PlanMaker {
 public:
  virtual ~PlanMaker() = default;
  // False while it still works at a plan that nobody waits for.
  virtual bool start(std::shared_ptr<const PlanJob> job, Utime now) = 0;
  // Of the newest job, once, when it is there. Pressing: it is waited for, if that is a matter of a moment.
  virtual std::optional<FullPlan> result(Utime now, bool pressing) = 0;
};

class PlanAtOnce final : public PlanMaker {
 public:
  bool start(std::shared_ptr<const PlanJob> job, Utime /*now*/) override {
    plan_ = job->run();
    return true;
  }
  std::optional<FullPlan> result(Utime /*now*/, bool /*pressing*/) override {
    return std::exchange(plan_, std::nullopt);
  }

 private:
  std::optional<FullPlan> plan_;
};

}  // namespace rover::planning
