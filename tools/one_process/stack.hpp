// Services in one process on an in-memory bus, in place of launcher and s6. In fault benches each can hang, die and be
// restarted.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/node.hpp"

namespace rover {

class Stack {
 public:
  using Factory = std::function<std::shared_ptr<void>(Node& node)>;

  // `run_dir`: folder of the checkpoints. `allow_injection`: the services apply the faults of INJECT.
  Stack(lcm::LCM& bus, std::string run_dir, bool allow_injection, double cpu_scale = 1.0)
      : bus_(bus), run_dir_(std::move(run_dir)), allow_injection_(allow_injection), cpu_scale_(cpu_scale) {}

  void add(const std::string& service, Factory factory);
  // Starts all; they report to a clock master on the bus.
  void start();
  // Delivers the published messages and lets the services process their ticks; false if no message waited.
  bool work();
  // Wall time that each service has used in work(), for benches.
  const std::map<std::string, double>& seconds_of_service() const { return seconds_; }
  // For a bus without clock master: publishes the tick to all running services, and lets them work.
  void tick(Utime now);

  void hang(const std::string& service, bool on) { find(service).hangs = on; }
  // Restarted after this time, as by s6.
  void kill(const std::string& service, double away_s);
  // Overrides the status in its heartbeats; OK: no override.
  void set_status(const std::string& service, std::int8_t status);
  // The status persists after a kill.
  void set_stuck(const std::string& service, bool on) { find(service).stuck = on; }
  std::int64_t boots(const std::string& service) { return find(service).boots; }
  bool runs(const std::string& service) { return find(service).node != nullptr; }

 private:
  struct Process {
    std::string name;
    Factory factory;
    std::unique_ptr<Node> node;     // null: dead
    std::shared_ptr<void> service;  // on the node
    std::int64_t boots = 0;
    Utime back_at = 0;
    bool hangs = false;
    bool stuck = false;
    std::int8_t status = heartbeat_t::OK;
  };
  Process& find(const std::string& service);
  void start(Process& process);
  bool drain();

  lcm::LCM& bus_;
  std::string run_dir_;
  bool allow_injection_;
  double cpu_scale_;
  Utime now_ = 0;
  StreamCounter ticks_{"rover_simulator", 1};
  std::vector<std::unique_ptr<Process>> processes_;
  std::map<std::string, double> seconds_;
};

}  // namespace rover
