// Triggers the scenario's faults by message time, true distance driven or supervisor state.
#pragma once

#include <set>
#include <vector>

#include "common/core/time.hpp"
#include "rover_simulator/world/scenario_faults.hpp"

namespace rover {

class FaultScript {
 public:
  FaultScript(std::vector<ScriptedFault> faults, Utime start) : waiting_(std::move(faults)), start_(start) {}

  void entered(std::int8_t state) { entered_.insert(state); }
  // Faults that begin now, in the order of the list; each is returned once.
  std::vector<FaultRequest> take_due(Utime now, double driven_m) {
    std::vector<FaultRequest> due;
    std::erase_if(waiting_, [&](const ScriptedFault& fault) {
      const bool begins = (fault.at_s && to_seconds(now - start_) >= *fault.at_s) ||
                          (fault.after_m && driven_m >= *fault.after_m) ||
                          (fault.at_state && entered_.contains(*fault.at_state));
      if (begins) due.push_back(fault.order);
      return begins;
    });
    return due;
  }

 private:
  std::vector<ScriptedFault> waiting_;
  Utime start_;
  std::set<std::int8_t> entered_;
};

}  // namespace rover
