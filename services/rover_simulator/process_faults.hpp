// Blows to processes that the simulator deals in lockstep: whom, when he takes part, and how long the world does
// without.
#pragma once

#include <string>
#include <vector>

#include "common/bus/faults.hpp"
#include "common/core/barrier.hpp"

namespace rover {

struct ProcessBlow {
  std::string service;
  int signal = 0;
  Utime away = 0;  // message time until its next process takes part
};

class ProcessFaults {
 public:
  // Faults of FaultTarget::kService.
  void order(const FaultOrder& order);
  // Blows to deal now. One to a service that is away waits until it is back.
  std::vector<ProcessBlow> take_due(const Barrier& barrier);

 private:
  struct Waiting {
    ProcessBlow blow;
    int times = 1;
  };
  std::vector<Waiting> waiting_;
};

}  // namespace rover
