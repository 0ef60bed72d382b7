// What s6 and the operating system know of the services' processes.
#pragma once

#include <map>
#include <string>

#include "tools/status/snapshot.hpp"

namespace rover::status {

// CPU seconds and resident memory of any process of this machine.
struct ProcessUsage {
  bool exists = false;
  double cpu_s = kNaN;
  double rss_mb = kNaN;
};
ProcessUsage usage_of(int pid);

class Processes {
 public:
  // `run_dir`: whose services s6 keeps; empty: those that the bus names, alone.
  explicit Processes(std::string run_dir) : run_dir_(std::move(run_dir)) {}

  // CPU figures are over the time since the look before, and not known of a process that it did not see.
  // `heard`: process numbers by the services' own word, for those that s6 does not keep.
  void look(const std::map<std::string, int>& heard, double wall_s);
  const std::map<std::string, ProcessFigures>& figures() const { return figures_; }

 private:
  struct Look {
    double cpu_s = kNaN;
    double wall_s = kNaN;
  };
  void measure(ProcessFigures& figures, double wall_s, std::map<int, Look>& looks) const;

  std::string run_dir_;
  std::map<std::string, ProcessFigures> figures_;
  std::map<int, Look> before_;  // by process number
};

}  // namespace rover::status
