// The services of the stack in one process, as the launcher and s6 keep them on the rover: each can hang, die and come
// back; all take part in the same ticks on one bus in memory.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/node.hpp"

namespace rover::bench_faults {

class Stack {
 public:
  using Factory = std::function<std::shared_ptr<void>(Node& node)>;

  // `run_dir` holds the checkpoints.
  Stack(lcm::LCM& bus, std::string run_dir) : bus_(bus), run_dir_(std::move(run_dir)) {}

  void add(const std::string& service, Factory factory);
  // What has been published before, and then the tick, for all that run.
  void tick(Utime now);

  void hang(const std::string& service, bool on) { find(service).hangs = on; }
  // s6 starts it again after that time.
  void kill(const std::string& service, double away_s);
  // What its heartbeats say, over its own word; OK: its own word.
  void set_status(const std::string& service, std::int8_t status);
  // Kills do not help.
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
  void drain();

  lcm::LCM& bus_;
  std::string run_dir_;
  Utime now_ = 0;
  StreamCounter ticks_{"rover_simulator", 1};
  std::vector<std::unique_ptr<Process>> processes_;
};

}  // namespace rover::bench_faults
