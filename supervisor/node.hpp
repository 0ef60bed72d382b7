// LCM node: subscribes to all monitored streams, publishes DRIVE_PERMIT each tick, states, faults and acknowledgements.
#pragma once

#include <functional>
#include <map>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/node.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

class SupervisorNode {
 public:
  // Kills a service so that s6 restarts it; returns false on failure.
  using Kill = std::function<bool(const std::string& service)>;
  SupervisorNode(Node& node, const SupervisorConfig& config, Kill kill);

 private:
  void subscribe();
  void subscribe_vehicle();
  void step(Utime now);
  void withdraw_permit();
  void restore();
  void save();
  void publish_answers(const std::vector<CommandAnswer>& answers, Utime now);
  void publish_faults(const SupervisorOutput& output, Utime now);
  void publish_states(const SupervisorOutput& output, Utime now);
  void publish_state(const StateChange& change, Utime now);
  void publish_fault(const FaultChange& change, Utime now);
  void restart(const std::string& service);

  Node& node_;
  CheckpointStore checkpoint_;
  Kill kill_;
  Pose2 body_odom_{};  // newest pose
  Supervisor supervisor_;
  PersistentState saved_;
  std::map<std::string, int> pids_;
};

}  // namespace rover::supervisor
