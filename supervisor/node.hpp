// The supervisor on the bus: reads every stream's state, grants DRIVE_PERMIT each tick, answers the ground.
#pragma once

#include "common/bus/node.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

class SupervisorNode {
 public:
  SupervisorNode(Node& node, const SupervisorConfig& config);

 private:
  void subscribe();
  void step(Utime now);
  void publish_state(const StateChange& change, Utime now);
  void publish_changes(const SupervisorOutput& output, Utime now);

  Node& node_;
  Supervisor supervisor_;
};

}  // namespace rover::supervisor
