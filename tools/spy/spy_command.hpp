// ./rover spy: shows every channel of a bus or of a log.
#pragma once

#include <set>
#include <string>

#include "tools/status/target.hpp"

namespace rover::spy {

struct SpyArguments {
  std::string log;  // log file or run folder; empty: the bus
  int log_run = 0;  // selects a run of a log with several; 0: the only one
  status::TargetArguments target;
  std::set<std::string> channels;  // empty: all channels, one row each
  double for_s = 0.0;              // 0: until Ctrl-C
  bool once = false;
  bool json = false;
};

// Exit status: 0 if something was shown, 1 if there was no traffic. Throws ConfigError.
int spy(const SpyArguments& arguments);

}  // namespace rover::spy
