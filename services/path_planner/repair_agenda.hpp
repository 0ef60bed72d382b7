// The order in which a repair is looked for, kept from frame to frame: each demand with the wide margin, then the tight
// one, and in each the lead-ins. A planner that works on a frame for longer than its consumers wait is as good as dead
// (planner_age), so a frame begins no further search once its share of work is done, and the next one goes on.
#pragma once

#include <cstddef>
#include <vector>

#include "path_planner/local_repair.hpp"

namespace rover::planning {

// What a repair has to fulfil: way over ground that is seen in time, and how near to the goal one that ends there.
struct WayDemand {
  double sure_m = kInfinity;
  double goal_reach_m = 0.0;
};

class RepairAgenda {
 public:
  static constexpr size_t kMargins = 2;

  size_t demand() const { return demand_; }
  size_t margin() const { return margin_; }
  size_t lead() const { return lead_; }

  // To the next search after one that found nothing. False at the end; the agenda then stands at its beginning.
  bool advance(RepairStatus status, const std::vector<WayDemand>& demands, size_t leads) {
    unseen_ = unseen_ || status == RepairStatus::kUnseen;
    if (++lead_ < leads) return true;
    lead_ = 0;
    if (++margin_ < kMargins) return true;
    margin_ = 0;
    const double reach_m = demands[demand_].goal_reach_m;
    do {
      ++demand_;
    } while (demand_ < demands.size() && !unseen_ && demands[demand_].goal_reach_m == reach_m);
    unseen_ = false;
    if (demand_ < demands.size()) return true;
    restart();
    return false;
  }

  void restart() { *this = RepairAgenda(); }
  // Demands come and go with the rover's place: from the beginning where this one is no more.
  void fit(size_t demands) {
    if (demand_ >= demands) restart();
  }

 private:
  size_t demand_ = 0;
  size_t margin_ = 0;
  size_t lead_ = 0;
  bool unseen_ = false;  // a way was dropped for unseen ground; else asking for less of it finds the same
};

}  // namespace rover::planning
