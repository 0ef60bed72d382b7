// ./rover status: finds the run, listens to its bus for a moment, and shows.
#pragma once

#include <string>

namespace rover::status {

struct StatusArguments {
  std::string logs_dir = "logs";  // holds the runs
  std::string run;                // run folder; empty: the one in logs_dir that runs
  std::string bus;                // LCM URL; empty: the run's. Without a run: the bus alone
  bool json = false;
  bool watch = false;
};

// Exit status: 0 when something was shown, 1 where nothing runs. Throws ConfigError.
int show_status(const StatusArguments& arguments);

}  // namespace rover::status
