// State of the services' processes from s6 and the operating system.
#pragma once

#include <map>
#include <string>

#include "tools/status/snapshot.hpp"

namespace rover::status {

// CPU time and resident memory of a process.
struct ProcessUsage {
  bool exists = false;
  double cpu_s = kNaN;
  double rss_mb = kNaN;
};
ProcessUsage usage_of(int pid);

class Processes {
 public:
  // `run_dir`: run folder with the s6 services; empty: only processes named on the bus.
  explicit Processes(std::string run_dir) : run_dir_(std::move(run_dir)) {}

  // CPU load is the mean since the previous call. `reported_pids`: process ids from heartbeats, for services outside
  // s6.
  void sample(const std::map<std::string, int>& reported_pids, double wall_s);
  const std::map<std::string, ProcessFigures>& figures() const { return figures_; }

 private:
  struct UsageSample {
    double cpu_s = kNaN;
    double wall_s = kNaN;
  };
  void measure(ProcessFigures& figures, double wall_s, std::map<int, UsageSample>& samples) const;

  std::string run_dir_;
  std::map<std::string, ProcessFigures> figures_;
  std::map<int, UsageSample> previous_;  // by process id
};

}  // namespace rover::status
