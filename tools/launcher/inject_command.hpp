// ./rover inject: injects a fault into a running system, through s6 or as INJECT on its bus.
#pragma once

#include <limits>
#include <string>

namespace rover {

struct InjectArguments {
  std::string source_dir = ".";  // its logs/ are searched for the run
  std::string fault;
  std::string target;
  double amount = std::numeric_limits<double>::quiet_NaN();  // NaN: not given
  double for_s = std::numeric_limits<double>::quiet_NaN();   // NaN: not given
  std::string run_dir;
  bool list = false;
};

// Exit status 0. Throws ConfigError with one line.
int inject(const InjectArguments& arguments);

}  // namespace rover
