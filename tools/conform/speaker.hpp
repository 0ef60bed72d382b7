// Gives the trial's commands on the bus.
#pragma once

#include <lcm/lcm-cpp.hpp>

#include "common/bus/streams.hpp"
#include "tools/conform/trial.hpp"

namespace rover::conform {

class Speaker {
 public:
  Speaker(lcm::LCM& lcm, std::int64_t boot_id) : lcm_(lcm), streams_("conform", boot_id) {}
  // What the trial has to say at the tick.
  void say(const Trial& trial, Utime now);

 private:
  void give(const Command& command, Utime now);
  void give(Damaged damaged, Utime now);

  lcm::LCM& lcm_;
  StreamCounter streams_;
};

}  // namespace rover::conform
