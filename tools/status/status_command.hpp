// ./rover status: finds the run, listens to its bus, and shows the status.
#pragma once

#include "tools/status/target.hpp"

namespace rover::status {

struct StatusArguments {
  TargetArguments target;
  bool json = false;
  bool watch = false;
};

// Exit status: 0 if something was shown, 1 if nothing runs. Throws ConfigError.
int show_status(const StatusArguments& arguments);

}  // namespace rover::status
