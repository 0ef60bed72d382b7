// LCM node: subscribes to all monitored streams, publishes DRIVE_PERMIT each tick, states, faults and acknowledgements.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/node.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

class SupervisorNode {
 public:
  // Applies an option of s6-svc(8) to a service; false if s6 does not supervise it.
  using Control = std::function<bool(const std::string& service, const char* option)>;
  SupervisorNode(Node& node, const SupervisorConfig& config, Control control);

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
  void run_full_services(std::optional<bool> run);

  Node& node_;
  CheckpointStore checkpoint_;
  Control control_;
  std::vector<std::string> on_demand_services_;
  double origin_height_m_;
  std::vector<std::string> to_control_;  // of them, with the option
  const char* option_ = "";
  Pose2 body_odom_{};  // newest pose
  Supervisor supervisor_;
  PersistentState saved_;
  bool not_saved_ = false;
  std::map<std::string, int> pids_;
};

}  // namespace rover::supervisor
