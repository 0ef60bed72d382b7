// ./rover run: one run from its folder to its report.
#pragma once

#include "tools/launcher/arguments.hpp"

namespace rover {

struct RunResult {
  int exit_status = 1;  // 0: goal reached without collision; 2: bad input; 1: anything else
  std::string dir;      // run folder; empty if none
};

RunResult run(const RunArguments& arguments);

}  // namespace rover
