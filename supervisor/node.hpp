// The supervisor on the bus: reads every stream's state, grants DRIVE_PERMIT each tick, answers the ground.
#pragma once

#include <functional>
#include <map>

#include "common/bus/kept_state.hpp"
#include "common/bus/node.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

class SupervisorNode {
 public:
  // Kills the service, so that it starts anew; false where that is not possible.
  using Kill = std::function<bool(const std::string& service)>;
  SupervisorNode(Node& node, const SupervisorConfig& config, Kill kill);

 private:
  void subscribe();
  void subscribe_vehicle();
  void step(Utime now);
  void withdraw();
  void restore();
  void save();
  void publish_answers(const std::vector<CommandAnswer>& answers, Utime now);
  void publish_faults(const SupervisorOutput& output, Utime now);
  void publish_states(const SupervisorOutput& output, Utime now);
  void publish_state(const StateChange& change, Utime now);
  void publish_fault(const FaultChange& change, Utime now);
  void restart(const std::string& service);

  Node& node_;
  KeptState kept_;
  Kill kill_;
  Pose2 body_odom_{};  // newest
  Supervisor supervisor_;
  Memory saved_;
  std::map<std::string, int> pids_;
};

}  // namespace rover::supervisor
