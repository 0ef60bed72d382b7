// Publishes the trial's commands on the bus.
#pragma once

#include <lcm/lcm-cpp.hpp>

#include "common/bus/streams.hpp"
#include "tools/conform/trial.hpp"

namespace rover::conform {

class TrialPublisher {
 public:
  TrialPublisher(lcm::LCM& lcm, std::int64_t boot_id) : lcm_(lcm), streams_("conform", boot_id) {}
  // Publishes the trial's output at this tick.
  void publish(const Trial& trial, Utime now);

 private:
  void publish(const Command& command, Utime now);
  void publish(Damaged damaged, Utime now);

  lcm::LCM& lcm_;
  StreamCounter streams_;
};

}  // namespace rover::conform
