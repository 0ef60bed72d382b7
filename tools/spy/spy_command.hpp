// ./rover spy: shows every channel of a bus, or of a log.
#pragma once

#include <set>
#include <string>

#include "tools/status/target.hpp"

namespace rover::spy {

struct SpyArguments {
  std::string log;  // a log or a run's folder; empty: the bus
  int log_run = 0;  // of a log that holds several; 0: the only one
  status::TargetArguments target;
  std::set<std::string> channels;  // empty: all, a row each
  double for_s = 0.0;              // 0: until Ctrl-C
  bool once = false;
  bool json = false;
};

// Exit status: 0 when something was shown, 1 where nothing was heard. Throws ConfigError.
int spy(const SpyArguments& arguments);

}  // namespace rover::spy
