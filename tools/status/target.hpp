// Which bus a command listens to: that of a run, or one named by hand.
#pragma once

#include <optional>
#include <string>

namespace rover::status {

struct TargetArguments {
  std::string logs_dir = "logs";  // holds the runs
  std::string run;                // run folder; empty: the one in logs_dir that runs
  std::string bus;                // LCM URL; empty: the run's. Without a run: the bus alone
};

struct Target {
  std::string run_dir;  // empty: none
  std::string bus_url;
};

// Empty where nothing runs; one line on stderr says so. Throws ConfigError.
std::optional<Target> find_target(const TargetArguments& arguments);

}  // namespace rover::status
