// Signals that the simulator sends to service processes in lockstep: target, signal and absence from the barrier.
#pragma once

#include <string>
#include <vector>

#include "common/bus/faults.hpp"
#include "common/core/barrier.hpp"

namespace rover {

struct ProcessSignal {
  std::string service;
  int signal = 0;
  Utime absence = 0;  // message time until the restarted process rejoins the barrier
};

class ProcessFaults {
 public:
  // Faults of FaultTarget::kService.
  void order(const FaultRequest& order);
  // Signals to send now. A signal to an absent service waits until it has rejoined.
  std::vector<ProcessSignal> take_due(const Barrier& barrier);

 private:
  struct Pending {
    ProcessSignal signal_order;
    int times = 1;
  };
  std::vector<Pending> pending_;
};

}  // namespace rover
