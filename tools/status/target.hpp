// Selects the bus that a command listens to: the bus of a run, or --bus.
#pragma once

#include <optional>
#include <string>

namespace rover::status {

struct TargetArguments {
  std::string logs_dir = "logs";  // contains the run folders
  std::string run;                // run folder; empty: the running one in logs_dir
  std::string bus;                // LCM URL; empty: that of the run. Without a run: only the bus
};

struct Target {
  std::string run_dir;  // empty: no run
  std::string bus_url;
};

// Empty if nothing runs (prints one line on stderr). Throws ConfigError.
std::optional<Target> find_target(const TargetArguments& arguments);

}  // namespace rover::status
