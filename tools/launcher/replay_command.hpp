// ./rover replay: plays a log back on the bus, with selected services live.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/arguments.hpp"

namespace rover {

struct ReplayArguments {
  RunArguments run;                   // folder, bus, settings
  std::string log;                    // file, or a run's folder
  int log_run = 0;                    // run number in a log of several runs; 0: the only one
  std::string config_dir;             // empty: that of the log's folder, else the project's
  std::vector<std::string> services;  // live; "all": every publisher in the log except recorder and mission_control
  bool check = false;
  bool loop = false;
  std::string speed = "1";  // or "max"
  double from_s = -1.0;     // message time; negative: from the beginning
  double until_s = -1.0;    // negative: to the end
};

// Exit status 1 if the check found a difference or a service ended. Throws ConfigError with one line.
int replay_log(const ReplayArguments& arguments);

}  // namespace rover
