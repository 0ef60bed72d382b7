// Work beside the steps of a node: plans take up to some tenths of a second.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "common/core/time.hpp"
#include "path_planner/search/plan.hpp"

namespace rover::planning {

using PlanJob = std::function<Plan()>;

class Background {
 public:
  virtual ~Background() = default;
  // False while it still works on a job whose result nobody waits for.
  virtual bool start(PlanJob job, Utime now) = 0;
  // Of the newest job, once.
  virtual std::optional<Plan> result(Utime now) = 0;
};

class AtOnce final : public Background {
 public:
  bool start(PlanJob job, Utime /*now*/) override {
    plan_ = job();
    return true;
  }
  std::optional<Plan> result(Utime /*now*/) override { return std::exchange(plan_, std::nullopt); }

 private:
  std::optional<Plan> plan_;
};

}  // namespace rover::planning
