// Everything that an injection can act on.
#pragma once

#include <string>

#include "test/bench_faults/ground.hpp"
#include "test/bench_faults/stand_ins.hpp"
#include "tools/one_process/stack.hpp"

namespace rover::bench_faults {

class Hands {
 public:
  Hands(lcm::LCM& bus, StandInRover& the_rover, Blindness& the_blindness, Stack& the_stack, Ground& the_ground)
      : rover(the_rover), blindness(the_blindness), stack(the_stack), ground(the_ground), bus_(bus) {}

  // INJECT to all nodes: a fault of channels, from now on.
  void tap(const std::string& fault, const std::string& target, double amount, double for_s);

  StandInRover& rover;
  Blindness& blindness;
  Stack& stack;
  Ground& ground;
  Utime now = 0;
  Utime clock_step = 0;  // jump of message time at the next tick

 private:
  lcm::LCM& bus_;
  std::int64_t injection_id_ = 0;
  StreamCounter streams_{"bench", 1};
};

}  // namespace rover::bench_faults
